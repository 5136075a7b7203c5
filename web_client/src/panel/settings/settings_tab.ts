// The tab of all other settings: presets, search, terms, and the generated sections.

import type { Viewer } from "../../session/viewer.ts";
import { element, icon, setText } from "../../widgets/element.ts";
import { requiresControl } from "../../widgets/requires_control.ts";
import { presetLabel } from "../../common/labels.ts";
import { findControls } from "./control_search.ts";
import { createTerms } from "./terms.ts";
import { mountSettings } from "./settings_sections.ts";

/** `showTab` selects another tab by its name. */
export function createSettingsTab(
  viewer: Viewer,
  shownElsewhere: string[],
  showTab: (id: string) => void,
): HTMLElement {
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
  const elsewhere = element("div", { class: "elsewhere", role: "group", hidden: true });
  elsewhere.setAttribute("aria-label", "Controls in other tabs");
  const find = (): void => {
    const here = mounted.filter(search.value);
    const others = findControls(elsewhere, search.value, showTab);
    noResults.hidden = here + others > 0;
    setText(noResults, "No matching settings.");
  };
  const searchBox = element("div", { class: "search" }, icon("search"), search);
  return element(
    "div",
    { class: "settings-tab" },
    requiresControl(viewer, createPresetChips(viewer)),
    element("div", { class: "toolbar" }, searchBox),
    noResults,
    elsewhere,
    createTerms(),
    requiresControl(viewer, sections),
  );
}

/** The presets in their order; the active one is marked. */
function createPresetChips(viewer: Viewer): HTMLElement {
  const chips = element("div", { class: "chips", role: "group", "aria-label": "Presets" });
  /** The preset that was in effect last; it is marked as modified when a setting changes. */
  let last = "";
  const mark = (): void => {
    const presets = viewer.capabilities.presets.value;
    const active = presets.find(({ settings }) => viewer.settings.matches(settings))?.name;
    last = active ?? last;
    for (const chip of chips.querySelectorAll<HTMLButtonElement>("button")) {
      const { preset } = chip.dataset;
      chip.setAttribute("aria-pressed", String(preset === active));
      chip.classList.toggle("modified", active === undefined && preset === last);
    }
  };
  const apply = async (name: string): Promise<void> => {
    try {
      await viewer.settings.choosePreset(name);
    } catch (error) {
      viewer.report(error);
    }
  };
  viewer.capabilities.presets.watch((presets) => {
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
