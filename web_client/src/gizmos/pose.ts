// What handles change: a place and a direction. A handle moves along an axis, moves parallel to the
// view, or turns the direction.

import type { Vector3 } from "heliograph/json.ts";
import { add, scale } from "../common/vector.ts";
import type { Projection, ViewPoint } from "../view/projection.ts";
import { metresAcross, metresAlong, turned } from "./drag_math.ts";

export interface Pose {
  /** Metres. */
  anchor: Vector3;
  /** Of unit length; null for what has none. */
  direction: Vector3 | null;
}

/** What a handle does. `tip` is the unit vector from the anchor to where the handle is drawn. */
export type Deed =
  | { kind: "along"; tip: Vector3 }
  | { kind: "across"; tip: null }
  | { kind: "turn"; tip: Vector3; opposite: boolean };

/**
 * The pose after a drag by CSS pixels. A handle that turns follows the pointer at `reach` pixels
 * from the anchor; `side` tells whether it was before or behind it when it was grasped.
 */
export function dragged(
  pose: Pose,
  deed: Deed,
  projection: Projection,
  delta: ViewPoint,
  { reach, side }: { reach: number; side: 1 | -1 },
): Pose {
  const { anchor } = pose;
  if (deed.kind === "turn") {
    const angles = { right: delta.x / reach, up: -delta.y / reach };
    return turnedPose(pose, deed, projection, angles, side);
  }
  const movement =
    deed.kind === "along"
      ? scale(deed.tip, metresAlong(projection, anchor, deed.tip, delta))
      : metresAcross(projection, anchor, delta);
  return { ...pose, anchor: add(anchor, movement) };
}

/** The pose after steps to the right and up, as arrow keys make: metres, or radians of turns. */
export function stepped(
  pose: Pose,
  deed: Deed,
  projection: Projection,
  { right, up }: { right: number; up: number },
  side: 1 | -1,
): Pose {
  if (deed.kind === "turn") return turnedPose(pose, deed, projection, { right, up }, side);
  const { rightward, upward } = projection.directions;
  const movement =
    deed.kind === "along"
      ? scale(deed.tip, right + up)
      : add(scale(rightward, right), scale(upward, up));
  return { ...pose, anchor: add(pose.anchor, movement) };
}

/** The tip, which is turned, is the direction or its opposite. */
function turnedPose(
  pose: Pose,
  { opposite }: Extract<Deed, { kind: "turn" }>,
  projection: Projection,
  angles: { right: number; up: number },
  side: 1 | -1,
): Pose {
  if (!pose.direction) return pose;
  const sign = opposite ? -1 : 1;
  const tip = turned(scale(pose.direction, sign), projection.directions, angles, side);
  return { ...pose, direction: scale(tip, sign) };
}
