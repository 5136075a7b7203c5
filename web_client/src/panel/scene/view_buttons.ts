// Views from the sides, and a camera that turns by itself.

import type { Vector3 } from "heliograph/json.ts";
import type { CameraPose } from "../../common/camera_pose.ts";
import { dot, normalize, subtract } from "../../common/vector.ts";
import { type ViewSide, seenFrom, viewSides } from "../../view/camera.ts";
import type { AutoRotate } from "../../view/auto_rotate.ts";
import type { Viewer } from "../../session/viewer.ts";
import { element } from "../../widgets/element.ts";

export function createViewButtons(viewer: Viewer, rotation: AutoRotate): HTMLElement {
  const sides = (Object.keys(viewSides) as ViewSide[]).map((side) =>
    element(
      "button",
      { type: "button", class: "button quiet", click: () => viewFrom(viewer, side) },
      `${side[0]?.toUpperCase()}${side.slice(1)}`,
    ),
  );
  const rotate = element(
    "button",
    { type: "button", class: "button quiet", click: () => rotation.toggle() },
    "Rotate",
  );
  rotation.running.watch((running) => rotate.setAttribute("aria-pressed", String(running)));
  return element(
    "div",
    { class: "tool-buttons view-buttons", role: "group", "aria-label": "View from" },
    ...sides,
    rotate,
  );
}

/** Through half a turn the transition would lead through the scene. */
const longestTransition = -0.5; // cosine

export function viewFrom(viewer: Viewer, side: ViewSide): void {
  const camera = viewer.camera.value;
  if (!camera || !viewer.membership.mayMove) return;
  const to = seenFrom(camera, side);
  const direction = ({ eye, target }: CameraPose): Vector3 => normalize(subtract(eye, target));
  const turns = dot(direction(camera), direction(to)) < longestTransition;
  if (turns) viewer.cameraMoves.moveTo(to);
  else viewer.cameraMoves.animateTo(to);
}
