// The Settings tab: presets, search, undo and redo, and the generated sections.

import type { JsonObject } from "heliograph/json.ts";
import type { Viewer } from "../../session/viewer.ts";
import { element, icon, setText } from "../../widgets/element.ts";
import { requiresControl } from "../../widgets/requires_control.ts";
import { presetLabel } from "../../common/labels.ts";
import { mountSettings } from "./settings_sections.ts";

interface Preset {
  name: string;
  description: string;
}

export function createSettingsTab(viewer: Viewer, shownElsewhere: string[]): HTMLElement {
  const sections = element("div", { class: "settings" });
  const mounted = mountSettings(sections, viewer.settings, {
    id: "settings",
    without: shownElsewhere,
  });
  const noResults = element("p", { class: "facts no-results", hidden: true });
  const search = element("input", {
    type: "search",
    name: "search",
    placeholder: "Search settings",
    "aria-label": "Search settings",
    autocomplete: "off",
    spellcheck: "false",
    input: () => find(),
    keydown: (event: KeyboardEvent) => {
      if (event.key !== "Escape" || search.value === "") return;
      event.stopPropagation();
      search.value = "";
      find();
    },
  });
  const find = (): void => {
    noResults.hidden = mounted.filter(search.value) > 0;
    setText(noResults, "No matching settings.");
  };
  const searchBox = element("div", { class: "search" }, icon("search"), search);
  return element(
    "div",
    { class: "settings-tab" },
    requiresControl(viewer, createPresetChips(viewer)),
    element("div", { class: "toolbar" }, searchBox),
    noResults,
    requiresControl(viewer, sections),
  );
}

/** The presets in their order; the active one is marked. */
function createPresetChips(viewer: Viewer): HTMLElement {
  const chips = element("div", { class: "chips", role: "group", "aria-label": "Presets" });
  let applied: { name: string; settings: JsonObject } | null = null;
  const mark = (): void => {
    for (const chip of chips.querySelectorAll<HTMLButtonElement>("button")) {
      const active = chip.dataset.preset === applied?.name;
      const unmodified = active && applied !== null && viewer.settings.matches(applied.settings);
      chip.setAttribute("aria-pressed", String(unmodified));
      chip.classList.toggle("modified", active && !unmodified);
    }
  };
  const apply = async (name: string): Promise<void> => {
    try {
      applied = { name, settings: await viewer.settings.choosePreset(name) };
      mark();
    } catch (error) {
      viewer.report(error);
    }
  };
  viewer.capabilities.presets.watch((presets: Preset[]) => {
    chips.hidden = presets.length === 0;
    chips.replaceChildren(
      ...presets.map(({ name, description }) =>
        element(
          "button",
          {
            type: "button",
            class: "chip",
            "data-preset": name,
            "data-tip": description,
            "aria-pressed": "false",
            click: () => void apply(name),
          },
          presetLabel(name),
        ),
      ),
    );
    mark();
  });
  viewer.settings.tree.watch(mark);
  return element("div", { class: "presets" }, element("h2", {}, "Denoiser presets"), chips);
}
