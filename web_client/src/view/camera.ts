// Camera movements as pure functions: a pose in, a pose out. World space, metres, +Y up.

import type { Camera, Vector3 } from "heliograph/messages.ts";
import { add, cross, dot, length, normalize, scale, subtract } from "../common/vector.ts";

const worldUp: Vector3 = [0, 1, 0];

/** The turntable stops this far from straight up and down, where its axis would flip. */
const steepestPitch = (89 * Math.PI) / 180;

/**
 * Turns around the target like a turntable, keeping the horizon level. Angles in radians: positive
 * yaw moves the eye to the right (the scene appears to turn left), positive pitch lifts the eye.
 */
export function orbit(camera: Camera, yaw: number, pitch: number): Camera {
  const offset = subtract(camera.eye, camera.target);
  const distance = length(offset);
  if (distance === 0) return camera;
  const lift = Math.asin(Math.min(1, Math.max(-1, offset[1] / distance)));
  const heading = headingOf(camera, offset) + yaw;
  const tilt = Math.min(steepestPitch, Math.max(-steepestPitch, lift + pitch));
  const turned: Vector3 = [
    distance * Math.cos(tilt) * Math.sin(heading),
    distance * Math.sin(tilt),
    distance * Math.cos(tilt) * Math.cos(heading),
  ];
  return { ...camera, eye: add(camera.target, turned), up: worldUp, name: null };
}

/**
 * Moves eye and target across the view so that the target plane follows the pointer. Distances are
 * fractions of the viewport's height: positive right and down, like pointer movements.
 */
export function pan(camera: Camera, right: number, down: number): Camera {
  const { rightward, upward, distance } = basis(camera);
  const span = visibleHeight(camera.vertical_fov, distance);
  const shift = add(scale(rightward, -right * span), scale(upward, down * span));
  return {
    ...camera,
    eye: add(camera.eye, shift),
    target: add(camera.target, shift),
    name: null,
  };
}

/**
 * Moves towards the target (factor < 1) or away from it (> 1). Closer than `nearest` metres the
 * target moves along, so that one can walk on through an interior instead of getting stuck.
 */
export function dolly(camera: Camera, factor: number, nearest: number, farthest: number): Camera {
  const offset = subtract(camera.eye, camera.target);
  const distance = length(offset);
  if (distance === 0) return camera;
  const backward = scale(offset, 1 / distance);
  const wanted = Math.min(farthest, distance * factor);
  const kept = Math.max(nearest, wanted);
  const eye = add(camera.eye, scale(backward, wanted - distance));
  return { ...camera, eye, target: subtract(eye, scale(backward, kept)), name: null };
}

/**
 * Like `dolly`, but towards a point of the target's plane, which stays where it is in the picture.
 * The point is given from the middle, in fractions of the viewport's height, right and down.
 */
export function dollyToPoint(
  camera: Camera,
  factor: number,
  [nearest, farthest]: [number, number],
  right: number,
  down: number,
): Camera {
  const { rightward, upward, distance } = basis(camera);
  if (distance === 0) return camera;
  const moved = dolly(camera, factor, nearest, farthest);
  const kept = Math.min(farthest, distance * factor) / distance;
  const span = visibleHeight(camera.vertical_fov, distance) * (1 - kept);
  const shift = add(scale(rightward, right * span), scale(upward, -down * span));
  return { ...moved, eye: add(moved.eye, shift), target: add(moved.target, shift) };
}

/** Turns the head: the eye stays, the target swings. Angles in radians, right and up positive. */
export function look(camera: Camera, right: number, up: number): Camera {
  const turned = orbit({ ...camera, eye: camera.target, target: camera.eye }, -right, up);
  return { ...turned, eye: camera.eye, target: turned.eye };
}

/** Moves eye and target along the view's own axes, metres. */
export function fly(camera: Camera, right: number, up: number, forward: number): Camera {
  const { rightward, upward } = basis(camera);
  const ahead = normalize(subtract(camera.target, camera.eye));
  const shift = add(add(scale(rightward, right), scale(upward, up)), scale(ahead, forward));
  return {
    ...camera,
    eye: add(camera.eye, shift),
    target: add(camera.target, shift),
    name: null,
  };
}

/** Puts a point of the world in the middle, seen from the same side from `distance` metres. */
export function focusOn(camera: Camera, point: Vector3, distance: number): Camera {
  const backward = normalize(subtract(camera.eye, camera.target));
  return { ...camera, eye: add(point, scale(backward, distance)), target: point, name: null };
}

/** The pose at a part of the way from one to another. */
export function between(from: Camera, to: Camera, part: number): Camera {
  const mix = (a: Vector3, b: Vector3): Vector3 => add(a, scale(subtract(b, a), part));
  return {
    eye: mix(from.eye, to.eye),
    target: mix(from.target, to.target),
    up: mix(from.up, to.up),
    vertical_fov: from.vertical_fov + (to.vertical_fov - from.vertical_fov) * part,
    name: part >= 1 ? to.name : null,
  };
}

/** Whether two poses show the same picture, up to single-precision noise. */
export function samePose(a: Camera, b: Camera): boolean {
  const tolerance = 1e-5 * (1 + length(subtract(a.eye, a.target)));
  return (
    length(subtract(a.eye, b.eye)) < tolerance &&
    length(subtract(a.target, b.target)) < tolerance &&
    Math.abs(a.vertical_fov - b.vertical_fov) < 1e-3
  );
}

/** Height in metres of what the view shows at a distance. The angle is in degrees. */
export function visibleHeight(verticalFov: number, distance: number): number {
  return 2 * distance * Math.tan((verticalFov * Math.PI) / 360);
}

function headingOf(camera: Camera, offset: Vector3): number {
  if (Math.hypot(offset[0], offset[2]) > 1e-6 * length(offset)) {
    return Math.atan2(offset[0], offset[2]);
  }
  // Seen from straight above (or below) the picture's up direction tells where "behind" is.
  const behind = scale(camera.up, offset[1] > 0 ? -1 : 1);
  return Math.atan2(behind[0], behind[2]);
}

function basis(camera: Camera): { rightward: Vector3; upward: Vector3; distance: number } {
  const toTarget = subtract(camera.target, camera.eye);
  const forward = normalize(toTarget);
  let rightward = normalize(cross(forward, camera.up));
  if (dot(rightward, rightward) === 0) rightward = [1, 0, 0];
  return { rightward, upward: cross(rightward, forward), distance: length(toTarget) };
}
