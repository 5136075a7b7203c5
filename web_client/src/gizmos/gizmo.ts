// The handles of one thing in the scene, and how they change it.

import type { Vector3 } from "heliograph/json.ts";
import type { SceneInfo } from "heliograph/messages.ts";
import { scale } from "../common/vector.ts";
import type { Deed, Pose } from "./pose.ts";

/** For assistive technology. */
interface HandleValue {
  now: number;
  least: number;
  most: number;
  text: string;
}

export interface Handle {
  /** Distinguishes it from others of the gizmo. */
  id: "x" | "y" | "z" | "normal" | "centre" | "turn";
  label: string;
  deed: Deed;
  value: HandleValue;
}

/** A change in progress, which is no step of the history until it is kept. */
export interface Edit {
  show(pose: Pose): void;
  /** Makes one step of the history; steps in quick succession with the same key are one. */
  keep(key: string): void;
  /** Brings back what was there before. */
  revert(): void;
}

export interface Gizmo {
  /** Gizmos of the same key have the same handles. */
  key: string;
  pose: Pose;
  handles: Handle[];
  /** Corners of a closed line. */
  outline: Vector3[];
  begin(kind: Deed["kind"]): Edit;
}

type Bounds = SceneInfo["bounds"];

const axes: Vector3[] = [
  [1, 0, 0],
  [0, 1, 0],
  [0, 0, 1],
];

/** Handles that move along the world's axes and across the view. */
export function moveHandles(name: string, anchor: Vector3, { min, max }: Bounds): Handle[] {
  const valueOf = (axis: number, text: string): HandleValue => {
    const now = anchor[axis] as number;
    const [least, most] = [min[axis] as number, max[axis] as number];
    return { now, least: Math.min(now, least), most: Math.max(now, most), text };
  };
  const alongAxes = axes.map(
    (tip, axis): Handle => ({
      id: (["x", "y", "z"] as const)[axis as 0 | 1 | 2],
      label: `Move ${name} along ${"XYZ"[axis]}`,
      deed: { kind: "along", tip },
      value: valueOf(axis, metres(anchor[axis] as number)),
    }),
  );
  const acrossView: Handle = {
    id: "centre",
    label: `Move ${name} across the view`,
    deed: { kind: "across", tip: null },
    value: valueOf(0, components(anchor)),
  };
  return [...alongAxes, acrossView];
}

/** A handle that turns a direction of unit length, drawn at its tip or opposite to it. */
export function turnHandle(name: string, direction: Vector3, opposite = false): Handle {
  const [x, , z] = direction;
  return {
    id: "turn",
    label: `Turn ${name}`,
    deed: { kind: "turn", tip: opposite ? scale(direction, -1) : direction, opposite },
    value: {
      now: (Math.atan2(x, -z) * 180) / Math.PI,
      least: -180,
      most: 180,
      text: `towards ${components(direction)}`,
    },
  };
}

export function metres(value: number): string {
  return `${number(value)} metres`;
}

function components([x, y, z]: Vector3): string {
  return `x ${number(x)}, y ${number(y)}, z ${number(z)}`;
}

/** Without the sign of what is shown as zero. */
function number(value: number): string {
  return value.toFixed(2).replace(/^-(?=[0.]+$)/, "").replace("-", "−");
}
