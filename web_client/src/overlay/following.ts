// Tells whose camera this page has, and ends that.

import type { Viewer } from "../session/viewer.ts";
import { element, setText } from "../widgets/element.ts";

export function mountFollowing({ membership }: Viewer, root: HTMLElement): void {
  const text = element("span", { class: "following-text" });
  const stop = element(
    "button",
    { type: "button", class: "following-stop", click: () => membership.stopFollowing() },
    "Stop",
  );
  stop.dataset.tip = "Keep the camera here and go on alone (Esc)";
  root.append(text, stop);
  membership.following.watch((followed) => {
    root.hidden = followed === null;
    setText(text, followed ? `Following ${followed.name}` : "");
  });
}
