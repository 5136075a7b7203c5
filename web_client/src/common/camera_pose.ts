import type { Vector3 } from "heliograph/json.ts";
import type { Camera } from "heliograph/messages.ts";
import { cross, dot, length, normalize, subtract } from "./vector.ts";

/** A camera as the server sends it, or one made by this page, which has no revision yet. */
export type CameraPose = Omit<Camera, "rev" | "fitted"> & Partial<Pick<Camera, "rev">>;

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
