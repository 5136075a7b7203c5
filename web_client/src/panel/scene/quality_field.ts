// Draft, balanced or best: the first control of the panel.

import type { Viewer } from "../../session/viewer.ts";
import { currentQuality, qualityLevels } from "./quality.ts";
import { element } from "../../widgets/element.ts";

export function createQualityField(viewer: Viewer): HTMLElement {
  const choices = qualityLevels.map((level) =>
    element(
      "button",
      {
        type: "button",
        class: "chip",
        "data-quality": level.name,
        "data-tip": level.description,
        click: () => viewer.settings.apply(level.settings),
      },
      level.label,
    ),
  );
  const mark = (): void => {
    const current = currentQuality(viewer.settings)?.name;
    for (const choice of choices) {
      choice.setAttribute("aria-pressed", String(choice.dataset.quality === current));
    }
  };
  viewer.settings.tree.watch(mark);
  viewer.settings.schema.watch(mark);
  return element(
    "div",
    { class: "field" },
    element("span", { class: "row-label" }, "Quality"),
    element("div", { class: "chips quality", role: "group", "aria-label": "Quality" }, ...choices),
  );
}
