import type { Viewer } from "../session/viewer.ts";
import { element } from "./element.ts";

/** Takes control of the session; for use where no viewer has it. */
export function createTakeControlButton(viewer: Viewer): HTMLButtonElement {
  return element(
    "button",
    {
      type: "button",
      class: "button quiet",
      click: () => void viewer.membership.setControl({ action: "take" }),
    },
    "Take control",
  );
}
