// A camera that moves along keys, as the server renders it: scene::camera_on_path().

import type { Vector3 } from "heliograph/json.ts";
import type { CameraPose } from "../common/camera_pose.ts";
import { add, cross, length, normalize, scale, subtract } from "../common/vector.ts";

export interface PathForm {
  /** A spline through the keys that begins and ends slowly. */
  smooth: boolean;
  /** Leads back to the first key. */
  closed: boolean;
}

type Four<T> = [T, T, T, T];

/** Of Catmull and Rom (1974), with a tension of one half. */
function splineWeights(t: number): Four<number> {
  return [
    0.5 * (-(t ** 3) + 2 * t ** 2 - t),
    0.5 * (3 * t ** 3 - 5 * t ** 2 + 2),
    0.5 * (-3 * t ** 3 + 4 * t ** 2 + t),
    0.5 * (t ** 3 - t ** 2),
  ];
}

function sumOf(weights: Four<number>, values: Four<number>): number {
  return weights.reduce((sum, weight, i) => sum + weight * (values[i] as number), 0);
}

function mixed(weights: Four<number>, values: Four<Vector3>): Vector3 {
  const zero: Vector3 = [0, 0, 0];
  return weights.reduce((sum, weight, i) => add(sum, scale(values[i] as Vector3, weight)), zero);
}

function mapped<T>(keys: Four<CameraPose>, property: (key: CameraPose) => T): Four<T> {
  return keys.map(property) as Four<T>;
}

function outward(key: CameraPose): Vector3 {
  return normalize(subtract(key.eye, key.target));
}

/** Where opposite directions meet, the camera goes around the side. */
function directionBetween(weights: Four<number>, keys: Four<CameraPose>): Vector3 {
  const between = mixed(weights, mapped(keys, outward));
  if (length(between) > 1e-3) return normalize(between);
  const side = cross(keys[1].up, outward(keys[1]));
  return length(side) > 0 ? normalize(side) : [1, 0, 0];
}

/** The camera at a fraction of its path, in [0, 1]. Keys stand at equal distances of time. */
export function cameraOnPath(
  keys: readonly CameraPose[],
  form: PathForm,
  fraction: number,
): CameraPose {
  const count = keys.length;
  if (count < 2) return keys[0] as CameraPose;
  const segments = form.closed ? count : count - 1;
  let at = Math.min(1, Math.max(0, fraction));
  if (form.smooth && !form.closed) at = at * at * (3 - 2 * at);
  at *= segments;
  const first = Math.min(Math.floor(at), segments - 1);
  const t = at - first;
  const weights: Four<number> = form.smooth ? splineWeights(t) : [0, 1 - t, t, 0];
  const near = [first - 1, first, first + 1, first + 2].map((key) => {
    const known = form.closed ? (key + count) % count : Math.min(count - 1, Math.max(0, key));
    return keys[known];
  }) as Four<CameraPose>;
  const distance = Math.exp(
    sumOf(
      weights,
      mapped(near, (key) => Math.log(length(subtract(key.eye, key.target)))),
    ),
  );
  const target = mixed(
    weights,
    mapped(near, (key) => key.target),
  );
  const up = mixed(
    weights,
    mapped(near, (key) => normalize(key.up)),
  );
  const fieldOfView = sumOf(
    weights,
    mapped(near, (key) => key.vertical_fov),
  );
  return {
    eye: add(target, scale(directionBetween(weights, near), distance)),
    target,
    up: length(up) > 1e-3 ? normalize(up) : near[1].up,
    vertical_fov: Math.min(170, Math.max(1, fieldOfView)),
    name: null,
  };
}
