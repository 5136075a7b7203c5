// Everything the renderer can be told: presets, a search, steps back and forth, and the generated
// sections.

import type { JsonObject } from "heliograph/messages.ts";
import type { Viewer } from "../../session/viewer.ts";
import { requiresControl } from "../../widgets/requires_control.ts";
import { button, element, icon, setText } from "../../widgets/element.ts";
import { presetLabel } from "./preset_labels.ts";
import { mountSettings } from "./settings_sections.ts";

interface Preset {
  name: string;
  description: string;
}

export function createSettingsTab(viewer: Viewer, handled: string[]): HTMLElement {
  const sections = element("div", { class: "settings" });
  const mounted = mountSettings(sections, viewer.settings, {
    id: "settings",
    without: handled,
  });
  const nothing = element("p", { class: "facts nothing", hidden: true });
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
    const found = mounted.filter(search.value);
    nothing.hidden = found > 0;
    setText(nothing, `No setting is called or described so.`);
  };
  const { settings } = viewer;
  const undo = button("Undo (Ctrl Z)", "undo", () => settings.undo());
  const redo = button("Redo (Ctrl Shift Z)", "redo", () => settings.redo());
  const enable = (): void => {
    undo.disabled = !viewer.mayChange || !settings.history.canUndo;
    redo.disabled = !viewer.mayChange || !settings.history.canRedo;
  };
  settings.tree.watch(enable);
  viewer.controlState.watch(enable);
  const searchBox = element("div", { class: "search" }, icon("search"), search);
  return element(
    "div",
    { class: "settings-tab" },
    requiresControl(viewer, createPresetChips(viewer)),
    element("div", { class: "toolbar" }, searchBox, undo, redo),
    nothing,
    requiresControl(viewer, sections),
  );
}

/** The presets in their order, the one in effect marked. */
function createPresetChips(viewer: Viewer): HTMLElement {
  const ladder = element("div", { class: "chips", role: "group", "aria-label": "Presets" });
  let chosen: { name: string; settings: JsonObject } | null = null;
  const mark = (): void => {
    for (const chip of ladder.querySelectorAll<HTMLButtonElement>("button")) {
      const active = chip.dataset.preset === chosen?.name;
      const kept = active && chosen !== null && viewer.settings.matches(chosen.settings);
      chip.setAttribute("aria-pressed", String(kept));
      chip.classList.toggle("left", active && !kept);
    }
  };
  const choose = async (name: string): Promise<void> => {
    try {
      chosen = { name, settings: await viewer.settings.choosePreset(name) };
      mark();
    } catch (error) {
      viewer.report(error);
    }
  };
  viewer.capabilities.presets.watch((presets: Preset[]) => {
    ladder.hidden = presets.length === 0;
    ladder.replaceChildren(
      ...presets.map(({ name, description }) =>
        element(
          "button",
          {
            type: "button",
            class: "chip",
            "data-preset": name,
            "data-tip": description,
            "aria-pressed": "false",
            click: () => void choose(name),
          },
          presetLabel(name),
        ),
      ),
    );
    mark();
  });
  viewer.settings.tree.watch(mark);
  return element("div", { class: "ladder" }, element("h2", {}, "Denoiser presets"), ladder);
}
