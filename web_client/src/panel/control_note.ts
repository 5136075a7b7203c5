// Why the controls below are out of use, and the way to get them back.

import { explained } from "../session/control_state.ts";
import type { Viewer } from "../session/viewer.ts";
import { element, icon, setText } from "../widgets/element.ts";
import { createTakeControlButton } from "../widgets/take_control_button.ts";

export function createControlNote(viewer: Viewer): HTMLElement {
  const text = element("p");
  const take = createTakeControlButton(viewer);
  const words = element("div", {}, text, take);
  const note = element("div", { class: "control-note", role: "status" }, icon("people"), words);
  viewer.controlState.watch((controlState) => {
    note.hidden = controlState.kind === "may_change";
    take.hidden = controlState.kind !== "nobody";
    setText(text, explained(controlState));
  });
  return note;
}
