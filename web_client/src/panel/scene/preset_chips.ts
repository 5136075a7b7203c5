// A row of choices, each of which stands for a group of settings.

import type { JsonObject } from "heliograph/json.ts";
import type { Viewer } from "../../session/viewer.ts";
import { element } from "../../widgets/element.ts";

export interface SettingsPreset {
  name: string;
  label: string;
  description: string;
  /** null: the server's default. */
  settings: JsonObject;
}

/** The choice whose settings are all in effect is marked; with others none is. */
export function createPresetChips(
  viewer: Viewer,
  label: string,
  presets: SettingsPreset[],
): HTMLElement {
  const chips = presets.map(({ label, description, settings }) =>
    element(
      "button",
      {
        type: "button",
        class: "chip",
        "data-tip": description,
        click: () => viewer.settings.apply(settings),
      },
      label,
    ),
  );
  const mark = (): void => {
    const current = presets.findIndex(({ settings }) => viewer.settings.matches(settings));
    chips.forEach((chip, index) => chip.setAttribute("aria-pressed", String(index === current)));
  };
  viewer.settings.tree.watch(mark);
  viewer.settings.schema.watch(mark);
  return element(
    "div",
    { class: "field" },
    element("span", { class: "row-label" }, label),
    element("div", { class: "chips presets", role: "group", "aria-label": label }, ...chips),
  );
}
