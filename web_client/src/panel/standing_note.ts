// Why the controls below are out of use, and the way to get them back.

import { takeButton } from "../overlay/people.ts";
import { explained } from "../standing.ts";
import type { Viewer } from "../viewer.ts";
import { element, icon, setText } from "./element.ts";

export function createStandingNote(viewer: Viewer): HTMLElement {
  const text = element("p");
  const take = takeButton(viewer);
  const words = element("div", {}, text, take);
  const note = element("div", { class: "standing-note", role: "status" }, icon("people"), words);
  viewer.standing.watch((standing) => {
    note.hidden = standing.kind === "may_change";
    take.hidden = standing.kind !== "nobody";
    setText(text, explained(standing));
  });
  return note;
}
