// Explains why the controls below are disabled, and offers to take control.

import { describeControl } from "../session/control_state.ts";
import type { Viewer } from "../session/viewer.ts";
import { element, icon, setText } from "../widgets/element.ts";
import { createTakeControlButton } from "../widgets/take_control_button.ts";

export function createControlNote(viewer: Viewer): HTMLElement {
  const text = element("p");
  const take = createTakeControlButton(viewer);
  const follow = element(
    "button",
    {
      type: "button",
      class: "button quiet",
      click: () => void viewer.membership.followAgain(),
    },
    "Follow again",
  );
  const body = element("div", {}, text, take, follow);
  const note = element(
    "div",
    { class: "control-note", role: "status" },
    icon("participants"),
    body,
  );
  viewer.membership.controlState.watch((controlState) => {
    note.hidden = controlState.kind === "may_change";
    take.hidden = controlState.kind !== "unclaimed";
    follow.hidden = controlState.kind !== "looks_around";
    setText(text, describeControl(controlState));
  });
  return note;
}
