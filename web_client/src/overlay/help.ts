// The list of what mouse, fingers and keys do.

import { button, element } from "../widgets/element.ts";

const entries: [title: string, rows: [keys: string[], meaning: string][]][] = [
  [
    "Mouse",
    [
      [["Drag"], "Orbit"],
      [["Right drag"], "Pan (also middle, or Shift and drag)"],
      [["Wheel"], "Towards what is under the pointer, and away"],
      [["Double click"], "Focus on what is there"],
    ],
  ],
  [
    "Touch",
    [
      [["One finger"], "Orbit"],
      [["Two fingers"], "Pan and pinch"],
    ],
  ],
  [
    "Keys",
    [
      [["←", "→", "↑", "↓"], "Orbit (with Shift: pan)"],
      [["+", "−"], "Closer, farther"],
      [["W", "A", "S", "D"], "Fly (Q, E: down, up; Shift: faster; drag: look)"],
      [["Space"], "Play or pause"],
      [["F"], "Fit the scene into view"],
      [["B"], "Bookmark this view"],
      [["Ctrl Z"], "Undo a setting (Ctrl Shift Z: redo)"],
      [["H"], "Hide or show the panel"],
      [["Enter"], "Fullscreen (with the picture focused)"],
      [["?"], "This help"],
    ],
  ],
];

export function createHelp(dialog: HTMLDialogElement): { open(): void } {
  const close = button("Close", "close", () => dialog.close());
  dialog.append(
    element("header", {}, element("h1", { id: "help-title" }, "Getting around"), close),
    ...entries.map(([title, rows]) =>
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
