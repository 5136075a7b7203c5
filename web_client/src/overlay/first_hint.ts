// Tells how to move, once in this browser: until the view is moved or the hint is closed.

import { preferences } from "../common/preferences.ts";
import type { Viewer } from "../session/viewer.ts";
import { button, element } from "../widgets/element.ts";

const seenKey = "hint_seen";

const withMouse = "Drag to orbit, wheel to zoom, double-click to focus. Press ? for more.";
const withFingers = "Drag to orbit, pinch to zoom, double-tap to focus.";

export function mountFirstHint(viewer: Viewer, view: HTMLElement, root: HTMLElement): void {
  if (preferences.flag(seenKey, false)) return;
  const touch = matchMedia("(pointer: coarse)").matches;
  const end = (): void => {
    preferences.setFlag(seenKey, true);
    for (const event of movements) view.removeEventListener(event, end);
    root.replaceChildren();
    root.hidden = true;
  };
  const movements = ["pointerdown", "wheel", "keydown"];
  root.append(element("p", {}, touch ? withFingers : withMouse), button("Close", "close", end));
  for (const event of movements) view.addEventListener(event, end, { passive: true });
  viewer.frame.watch((frame) => {
    root.hidden = !frame || !viewer.membership.mayMove || root.childElementCount === 0;
  });
}
