// The generated part of the panel: one collapsible section per group of settings.

import type { ControlGroup } from "heliograph/settings_schema.ts";
import type { SettingsStore } from "../../session/settings_store.ts";
import { element, icon, setText } from "../../widgets/element.ts";
import { createSection } from "../../widgets/section.ts";
import { type Row, createRow } from "../../widgets/setting_row.ts";

interface Section {
  node: HTMLElement;
  rows: Row[];
  showChanges(count: number): void;
}

interface SettingsParts {
  /** Distinguishes these sections from those of other tabs. */
  id: string;
  /** Only these groups; all when left out. */
  only?: string[];
  /** Groups and settings that are shown elsewhere. */
  without?: string[];
}

interface MountedSettings {
  /** Shows only settings that contain all words; returns their number. */
  filter(words: string): number;
}

/** Builds the sections and updates them when settings change. */
export function mountSettings(
  container: HTMLElement,
  store: SettingsStore,
  { id, only, without = [] }: SettingsParts,
): MountedSettings {
  let sections: Section[] = [];
  const update = (): void => {
    for (const section of sections) {
      let changes = 0;
      for (const row of section.rows) {
        const changed = store.isChanged(row.control);
        row.show(store.value(row.control.path), changed);
        if (changed) changes += 1;
      }
      section.showChanges(changes);
    }
  };
  store.schema.watch((schema) => {
    const shown = withoutPaths(schema, without);
    const groups = shown.groups.filter(({ path }) => !only || only.includes(path));
    const general = { ...shown, path: "general", title: "General", groups: [] };
    const all = shown.controls.length > 0 && !only ? [general, ...groups] : groups;
    sections = all.map((group, index) =>
      buildSection(group, store, { id, without, openByDefault: index === 0 || only !== undefined }),
    );
    container.replaceChildren(...sections.map(({ node }) => node));
    update();
  });
  store.tree.watch(update);
  return { filter: (words) => filterSections(container, sections, words) };
}

function filterSections(container: HTMLElement, sections: Section[], typed: string): number {
  const words = typed.toLowerCase().split(/\s+/).filter(Boolean);
  let total = 0;
  container.classList.toggle("searching", words.length > 0);
  for (const { node, rows } of sections) {
    const title = node.querySelector("h2")?.textContent ?? "";
    let matches = 0;
    for (const row of rows) {
      const { label, path, description } = row.control;
      const text = `${title} ${label} ${path} ${description}`.toLowerCase();
      row.node.hidden = !words.every((word) => text.includes(word));
      if (!row.node.hidden) matches += 1;
    }
    node.hidden = matches === 0;
    openForSearch(node, words.length > 0);
    total += matches;
    for (const part of node.querySelectorAll<HTMLElement>(".subgroup")) {
      part.hidden = part.querySelector(".row:not([hidden])") === null;
    }
  }
  return total;
}

/** Opens sections during a search and restores them afterwards. */
function openForSearch(node: HTMLElement, searching: boolean): void {
  const fold = node.querySelector("details");
  if (!fold || searching === (node.dataset.folded !== undefined)) return;
  if (searching) {
    node.dataset.folded = String(!fold.open);
    fold.open = true;
  } else {
    fold.open = node.dataset.folded !== "true";
    delete node.dataset.folded;
  }
}

function buildSection(
  group: ControlGroup,
  store: SettingsStore,
  { id, without, openByDefault }: { id: string; without: string[]; openByDefault: boolean },
): Section {
  const rows: Row[] = [];
  const body = element("div", { class: "section-body" });
  fill(body, group, store, rows);
  const count = element("span", { class: "change-count" });
  const resetAll = element(
    "button",
    {
      type: "button",
      class: "reset",
      "aria-label": `Reset all of ${group.title}`,
      "data-tip": "Reset this group",
      click: () => store.resetGroup(group, without),
    },
    icon("reset"),
  );
  const node = createSection({
    id: `${id}.${group.path}`,
    title: group.title,
    body,
    openByDefault,
    note: count,
    action: resetAll,
  });
  const showChanges = (changes: number): void => {
    setText(count, changes > 0 ? `${changes} changed` : "");
    node.classList.toggle("changed", changes > 0);
    resetAll.tabIndex = changes > 0 ? 0 : -1;
    resetAll.setAttribute("aria-hidden", String(changes === 0));
  };
  return { node, rows, showChanges };
}

function fill(body: HTMLElement, group: ControlGroup, store: SettingsStore, rows: Row[]): void {
  for (const control of group.controls) {
    const row = createRow(
      control,
      (value) => store.change(control.path, value),
      () => store.reset(control.path),
    );
    rows.push(row);
    body.append(row.node);
  }
  for (const inner of group.groups) {
    const part = element("div", { class: "subgroup", role: "group", "aria-label": inner.title });
    part.append(element("h3", {}, inner.title));
    fill(part, inner, store, rows);
    body.append(part);
  }
}

function withoutPaths(group: ControlGroup, paths: string[]): ControlGroup {
  return {
    ...group,
    controls: group.controls.filter(({ path }) => !paths.includes(path)),
    groups: group.groups
      .filter(({ path }) => !paths.includes(path))
      .map((inner) => withoutPaths(inner, paths))
      .filter((inner) => inner.controls.length > 0 || inner.groups.length > 0),
  };
}
