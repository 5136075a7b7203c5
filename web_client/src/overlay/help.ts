// The dialog that lists mouse, touch and keyboard controls.

import { button, element } from "../widgets/element.ts";

const entries: [title: string, rows: [keys: string[], meaning: string][]][] = [
  [
    "Mouse",
    [
      [["Drag"], "Orbit around the point under the pointer"],
      [["Right drag"], "Pan (also middle drag or Shift + drag)"],
      [["Wheel"], "Zoom to pointer"],
      [["Double click"], "Focus on the point under the pointer"],
      [["Click"], "Select an object, while Objects is unfolded (Shift: add)"],
      [["Click"], "Place a point, while measuring (Alt: nothing attracts it)"],
      [["Drag"], "On a handle: move or turn a light or section plane (Shift: finer; Esc: back)"],
    ],
  ],
  [
    "Touch",
    [
      [["One finger"], "Orbit"],
      [["Two fingers"], "Pan, pinch to zoom"],
      [["Double tap"], "Focus on the point under the finger"],
      [["One finger"], "On a handle: move or turn a light or section plane"],
    ],
  ],
  [
    "Keys",
    [
      [["←", "→", "↑", "↓"], "Orbit (with Shift: pan)"],
      [["←", "→", "↑", "↓"], "On a handle: move or turn by steps (with Shift: larger)"],
      [["+", "−"], "Zoom in, zoom out"],
      [["W", "A", "S", "D"], "Fly (Q, E: down, up; Shift: faster; drag: look around)"],
      [["Space"], "Play or pause"],
      [["F"], "Fit the scene into view"],
      [["1", "2", "3"], "View from the front, the right, the top (Shift: the other side)"],
      [["R"], "Rotate the view, or stop"],
      [["B"], "Bookmark this view"],
      [["Ctrl Z"], "Undo the last change (Ctrl Shift Z: redo)"],
      [["V"], "Hide or show an object (in the list of objects; Enter: select)"],
      [["M"], "Measure a distance (P: point in the middle of the view; Esc: end)"],
      [["Esc"], "Stop following another viewer"],
      [["N"], "Annotate a surface (P: in the middle of the view; Ctrl Enter: add)"],
      [["H"], "Hide or show the panel"],
      [["Enter"], "Fullscreen (while the view has the focus)"],
      [["?"], "Show this help"],
    ],
  ],
];

/** Gestures come first where there is no mouse. */
function inOrder(): typeof entries {
  const rank = ([title]: (typeof entries)[number]): number => (title === "Touch" ? 0 : 1);
  if (!matchMedia("(pointer: coarse)").matches) return entries;
  return [...entries].sort((a, b) => rank(a) - rank(b));
}

export function createHelp(dialog: HTMLDialogElement): { open(): void } {
  const close = button("Close", "close", () => dialog.close());
  dialog.append(
    element("header", {}, element("h1", { id: "help-title" }, "Navigation"), close),
    ...inOrder().map(([title, rows]) =>
      element(
        "section",
        {},
        element("h2", {}, title),
        element(
          "dl",
          {},
          ...rows.flatMap(([keys, meaning]) => [
            element("dt", {}, ...keys.map((key) => element("kbd", {}, key))),
            element("dd", {}, meaning),
          ]),
        ),
      ),
    ),
  );
  dialog.addEventListener("click", (event) => {
    if (event.target === dialog) dialog.close();
  });
  return {
    open() {
      if (!dialog.open) dialog.showModal();
    },
  };
}
