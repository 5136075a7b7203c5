// Camera movements as pure functions: a pose in, a pose out. World space, metres, +Y up.

import type { Vector3 } from "heliograph/json.ts";
import { type CameraPose, basis } from "../common/camera_pose.ts";
import { add, dot, length, normalize, scale, subtract } from "../common/vector.ts";

const worldUp: Vector3 = [0, 1, 0];

/** The turntable stops at this pitch, before the poles, where its axis would flip. */
const maxPitch = (89 * Math.PI) / 180;

/**
 * Orbits around the target like a turntable, with a level horizon. Angles in radians: positive yaw
 * moves the eye to the right (the scene appears to turn left), positive pitch raises the eye.
 */
export function orbit(camera: CameraPose, yaw: number, pitch: number): CameraPose {
  const offset = subtract(camera.eye, camera.target);
  const distance = length(offset);
  if (distance === 0) return camera;
  const oldPitch = Math.asin(Math.min(1, Math.max(-1, offset[1] / distance)));
  const heading = headingOf(camera, offset) + yaw;
  const newPitch = Math.min(maxPitch, Math.max(-maxPitch, oldPitch + pitch));
  const turned: Vector3 = [
    distance * Math.cos(newPitch) * Math.sin(heading),
    distance * Math.sin(newPitch),
    distance * Math.cos(newPitch) * Math.cos(heading),
  ];
  return { ...camera, eye: add(camera.target, turned), up: worldUp, name: null };
}

/**
 * Like `orbit`, but about any point: its place in the image stays, and the horizon stays level.
 */
export function orbitAround(
  camera: CameraPose,
  pivot: Vector3,
  yaw: number,
  pitch: number,
): CameraPose {
  const turned = orbit(camera, yaw, pitch);
  const [from, to] = [basis(camera), basis(turned)];
  const toPivot = subtract(pivot, camera.eye);
  const forward = normalize(subtract(camera.target, camera.eye));
  const turnedForward = normalize(subtract(turned.target, turned.eye));
  const seen = add(
    add(
      scale(to.rightward, dot(toPivot, from.rightward)),
      scale(to.upward, dot(toPivot, from.upward)),
    ),
    scale(turnedForward, dot(toPivot, forward)),
  );
  const eye = subtract(pivot, seen);
  return { ...turned, eye, target: add(eye, subtract(turned.target, turned.eye)) };
}

/**
 * Moves eye and target across the view so that the target plane follows the pointer. Distances are
 * fractions of the viewport's height: positive right and down, like pointer movements.
 */
export function pan(camera: CameraPose, right: number, down: number): CameraPose {
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
 * Moves towards the target (factor < 1) or away from it (> 1). Closer than `nearest` metres, the
 * target moves with the eye, so that the camera can pass through an interior.
 */
export function dolly(
  camera: CameraPose,
  factor: number,
  nearest: number,
  farthest: number,
): CameraPose {
  const offset = subtract(camera.eye, camera.target);
  const distance = length(offset);
  if (distance === 0) return camera;
  const backward = scale(offset, 1 / distance);
  const eyeDistance = Math.min(farthest, distance * factor);
  const targetDistance = Math.max(nearest, eyeDistance);
  const eye = add(camera.eye, scale(backward, eyeDistance - distance));
  return { ...camera, eye, target: subtract(eye, scale(backward, targetDistance)), name: null };
}

/**
 * Like `dolly`, but towards a point of the target's plane, whose position in the image stays fixed.
 * The point is relative to the centre, in fractions of the viewport's height, right and down.
 */
export function dollyToPoint(
  camera: CameraPose,
  factor: number,
  [nearest, farthest]: [number, number],
  right: number,
  down: number,
): CameraPose {
  const { rightward, upward, distance } = basis(camera);
  if (distance === 0) return camera;
  const moved = dolly(camera, factor, nearest, farthest);
  const remaining = Math.min(farthest, distance * factor) / distance;
  const span = visibleHeight(camera.vertical_fov, distance) * (1 - remaining);
  const shift = add(scale(rightward, right * span), scale(upward, -down * span));
  return { ...moved, eye: add(moved.eye, shift), target: add(moved.target, shift) };
}

/**
 * Scales the distance from a point of a surface, whose position in the image stays fixed: never
 * through the surface, and no closer than `nearest` metres.
 */
export function zoomTo(
  camera: CameraPose,
  factor: number,
  point: Vector3,
  [nearest, farthest]: [number, number],
): CameraPose {
  const distance = length(subtract(camera.eye, point));
  if (distance === 0) return camera;
  const wanted = Math.min(farthest, Math.max(nearest, distance * factor)) / distance;
  const limited = factor < 1 ? Math.min(1, wanted) : Math.max(1, wanted);
  const scaled = (from: Vector3): Vector3 => add(point, scale(subtract(from, point), limited));
  return { ...camera, eye: scaled(camera.eye), target: scaled(camera.target), name: null };
}

/** Rotates about the eye. Angles in radians, right and up positive. */
export function look(camera: CameraPose, right: number, up: number): CameraPose {
  const turned = orbit({ ...camera, eye: camera.target, target: camera.eye }, -right, up);
  return { ...turned, eye: camera.eye, target: turned.eye };
}

/** Moves eye and target along the camera's axes, metres. */
export function fly(camera: CameraPose, right: number, up: number, forward: number): CameraPose {
  const { rightward, upward } = basis(camera);
  const forwardAxis = normalize(subtract(camera.target, camera.eye));
  const shift = add(add(scale(rightward, right), scale(upward, up)), scale(forwardAxis, forward));
  return {
    ...camera,
    eye: add(camera.eye, shift),
    target: add(camera.target, shift),
    name: null,
  };
}

/** The sides from which a scene is seen; glTF's front is +Z. */
export const viewSides = {
  front: { toward: [0, 0, 1], up: worldUp },
  back: { toward: [0, 0, -1], up: worldUp },
  right: { toward: [1, 0, 0], up: worldUp },
  left: { toward: [-1, 0, 0], up: worldUp },
  top: { toward: [0, 1, 0], up: [0, 0, -1] },
  bottom: { toward: [0, -1, 0], up: [0, 0, 1] },
} satisfies Record<string, { toward: Vector3; up: Vector3 }>;

export type ViewSide = keyof typeof viewSides;

/** Shows the same target from one side, at the same distance. */
export function seenFrom(camera: CameraPose, side: ViewSide): CameraPose {
  const { toward, up } = viewSides[side];
  const distance = length(subtract(camera.eye, camera.target));
  const offset = scale(toward as Vector3, distance);
  return { ...camera, eye: add(camera.target, offset), up: up as Vector3, name: null };
}

/** Centres a point of the world, seen from the same direction at `distance` metres. */
export function focusOn(camera: CameraPose, point: Vector3, distance: number): CameraPose {
  const backward = normalize(subtract(camera.eye, camera.target));
  return { ...camera, eye: add(point, scale(backward, distance)), target: point, name: null };
}

/**
 * A pose that fits the scene into a frame of `frameAspect`, width by height, moved so that it fits
 * into a view that shows the middle of the frame, beside the part at the right that is covered, in
 * fractions of the view's width.
 */
export function fitBeside(
  camera: CameraPose,
  frameAspect: number,
  aspect: number,
  covered: number,
): CameraPose {
  const { rightward, distance } = basis(camera);
  const vertical = Math.tan((camera.vertical_fov * Math.PI) / 360);
  const sine = (horizontal: number): number => Math.sin(Math.atan(Math.min(vertical, horizontal)));
  const shown = vertical * Math.min(aspect, frameAspect);
  const factor = sine(vertical * frameAspect) / sine(shown * (1 - covered));
  const backward = normalize(subtract(camera.eye, camera.target));
  const shift = scale(rightward, covered * distance * factor * shown);
  const target = add(camera.target, shift);
  return { ...camera, eye: add(target, scale(backward, distance * factor)), target, name: null };
}

/** Interpolates between two poses; `t` in [0, 1]. */
export function interpolate(from: CameraPose, to: CameraPose, t: number): CameraPose {
  const mix = (a: Vector3, b: Vector3): Vector3 => add(a, scale(subtract(b, a), t));
  return {
    eye: mix(from.eye, to.eye),
    target: mix(from.target, to.target),
    up: mix(from.up, to.up),
    vertical_fov: from.vertical_fov + (to.vertical_fov - from.vertical_fov) * t,
    name: t >= 1 ? to.name : null,
  };
}

/** Height in metres of the visible area at a distance. The angle is in degrees. */
export function visibleHeight(verticalFov: number, distance: number): number {
  return 2 * distance * Math.tan((verticalFov * Math.PI) / 360);
}

function headingOf(camera: CameraPose, offset: Vector3): number {
  if (Math.hypot(offset[0], offset[2]) > 1e-6 * length(offset)) {
    return Math.atan2(offset[0], offset[2]);
  }
  // Seen from straight above or below, the camera's up vector gives the direction.
  const behind = scale(camera.up, offset[1] > 0 ? -1 : 1);
  return Math.atan2(behind[0], behind[2]);
}
