// What a drag over the view means in the world. Movements are small steps: each starts from the
// place that the one before has led to.

import type { Vector3 } from "heliograph/json.ts";
import { add, cross, dot, normalize, scale } from "../common/vector.ts";
import type { Projection, ViewPoint } from "../view/projection.ts";

/** An axis that points at the eye moves over the view as if it were this much of its length. */
const leastShare = 0.25;
/** Limits how fast a tip rolls that is on the other side: cosine of its angle to the eye. */
const leastFacing = -0.6;
/** Where an axis that points at the eye is drawn: downwards. */
const downwards: ViewPoint = { x: 0, y: 1 };

/** Metres along a unit vector at a point for a drag by `delta` CSS pixels. */
export function metresAlong(
  projection: Projection,
  position: Vector3,
  axis: Vector3,
  delta: ViewPoint,
): number {
  const motion = projection.motion(position, axis);
  if (!motion) return 0;
  const speed = Math.hypot(motion.x, motion.y);
  const least = leastShare * projection.pixelsPerMetre(position);
  const { x, y } = directionOf(motion, 1e-3 * least);
  return (delta.x * x + delta.y * y) / Math.max(speed, least);
}

/** The movement parallel to the view, metres, for a drag by `delta` CSS pixels at a point. */
export function metresAcross(
  projection: Projection,
  position: Vector3,
  delta: ViewPoint,
): Vector3 {
  const pixels = projection.pixelsPerMetre(position);
  if (pixels === 0) return [0, 0, 0];
  const { rightward, upward } = projection.directions;
  return add(scale(rightward, delta.x / pixels), scale(upward, -delta.y / pixels));
}

/** A vector turned about a unit vector, radians, counterclockwise where that points at the eye. */
export function rotated(vector: Vector3, about: Vector3, angle: number): Vector3 {
  const [cos, sin] = [Math.cos(angle), Math.sin(angle)];
  const along = scale(about, dot(about, vector) * (1 - cos));
  return add(add(scale(vector, cos), scale(cross(about, vector), sin)), along);
}

/**
 * A direction turned so that its tip follows the pointer over the view: by two angles, to the right
 * and up, radians. A tip before its anchor turns as the front of a ball, one behind it as the back;
 * where the ball ends in the view, the ball rolls as well.
 */
export function turned(
  direction: Vector3,
  view: Projection["directions"],
  { right, up }: { right: number; up: number },
  side: 1 | -1,
): Vector3 {
  const { rightward, upward } = view;
  const toEye = scale(view.forward, -1);
  const ball = rotated(rotated(direction, upward, side * right), rightward, -side * up);
  const [across, height] = [dot(direction, rightward), dot(direction, upward)];
  const radius = Math.hypot(across, height);
  if (radius < 1e-6) return normalize(ball);
  // What the ball's turn lacks around the middle of the view.
  const around = (up * across - right * height) / radius;
  const facing = Math.max(leastFacing, side * dot(direction, toEye));
  return normalize(rotated(ball, toEye, around * Math.sqrt((1 - facing) / (1 + facing))));
}

/** 1 for a direction whose tip is before its anchor as the view shows it, -1 for one behind it. */
export function sideOf(direction: Vector3, forward: Vector3): 1 | -1 {
  return dot(direction, forward) > 0 ? -1 : 1;
}

/**
 * Where the tip of a direction is drawn, CSS pixels from its anchor: `reach` where it lies across
 * the view and `least` where it points at the eye. Null where it cannot be seen.
 */
export function tipOffset(
  projection: Projection,
  anchor: Vector3,
  direction: Vector3,
  { reach, least }: { reach: number; least: number },
): ViewPoint | null {
  const pixels = projection.pixelsPerMetre(anchor);
  const from = projection.point(anchor);
  if (pixels === 0 || !from) return null;
  const tip = projection.point(add(anchor, scale(direction, reach / pixels)));
  if (!tip) return null;
  const offset = { x: tip.x - from.x, y: tip.y - from.y };
  const size = Math.hypot(offset.x, offset.y);
  if (size >= least) return offset;
  const { x, y } = directionOf(offset, 1e-3 * reach);
  return { x: least * x, y: least * y };
}

/** Of unit length; downwards for an offset shorter than `least`. */
function directionOf({ x, y }: ViewPoint, least: number): ViewPoint {
  const size = Math.hypot(x, y);
  return size > least ? { x: x / size, y: y / size } : downwards;
}
