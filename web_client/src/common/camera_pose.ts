import type { Vector3 } from "heliograph/json.ts";
import type { Camera } from "heliograph/messages.ts";
import { add, cross, dot, length, normalize, scale, subtract } from "./vector.ts";

/** A camera as the server sends it, or one made by this page, which has no revisions yet. */
export type CameraPose = Omit<Camera, "rev" | "scene_rev" | "fitted"> &
  Partial<Pick<Camera, "rev" | "scene_rev">>;

/** Unit vectors across the image, and the distance to the target. */
export function basis(camera: Pick<CameraPose, "eye" | "target" | "up">): {
  rightward: Vector3;
  upward: Vector3;
  distance: number;
} {
  const toTarget = subtract(camera.target, camera.eye);
  const forward = normalize(toTarget);
  let rightward = normalize(cross(forward, camera.up));
  if (dot(rightward, rightward) === 0) rightward = [1, 0, 0];
  return { rightward, upward: cross(rightward, forward), distance: length(toTarget) };
}

/**
 * The point at a place of the frame, in fractions of its width and height, at the target's distance
 * along the view. `aspect`: the frame's width by its height.
 */
export function targetPlaneAt(
  camera: Pick<CameraPose, "eye" | "target" | "up" | "vertical_fov">,
  aspect: number,
  { x, y }: { x: number; y: number },
): Vector3 {
  const { rightward, upward, distance } = basis(camera);
  const halfHeight = distance * Math.tan((camera.vertical_fov * Math.PI) / 360);
  const right = scale(rightward, (2 * x - 1) * halfHeight * aspect);
  return add(camera.target, add(right, scale(upward, (1 - 2 * y) * halfHeight)));
}
