// The generated part of the panel: one foldable section per group of settings.

import type { ControlGroup } from "../protocol/settings_schema.ts";
import type { SettingsStore } from "../settings_store.ts";
import { type Row, createRow } from "./controls.ts";
import { element, icon, setText } from "./element.ts";
import { createSection } from "./section.ts";

interface Section {
  rows: Row[];
  showChanges(count: number): void;
}

/** Builds the sections and keeps them in step. `handled` paths have a control elsewhere. */
export function mountSettings(
  container: HTMLElement,
  store: SettingsStore,
  handled: string[],
): void {
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
    const groups = withoutPaths(schema, handled).groups;
    const loose = withoutPaths(schema, handled).controls;
    const all =
      loose.length > 0
        ? [{ ...schema, path: "general", title: "General", controls: loose, groups: [] }, ...groups]
        : groups;
    const built = all.map((group, index) => buildSection(group, store, handled, index === 0));
    sections = built.map(({ section }) => section);
    container.replaceChildren(...built.map(({ node }) => node));
    update();
  });
  store.tree.watch(update);
}

function buildSection(
  group: ControlGroup,
  store: SettingsStore,
  handled: string[],
  openAtFirst: boolean,
): { node: HTMLElement; section: Section } {
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
      click: () => store.resetGroup(group, handled),
    },
    icon("reset"),
  );
  const node = createSection({
    id: `settings.${group.path}`,
    title: group.title,
    body,
    openAtFirst,
    note: count,
    action: resetAll,
  });
  const showChanges = (changes: number): void => {
    setText(count, changes > 0 ? `${changes} changed` : "");
    node.classList.toggle("changed", changes > 0);
    resetAll.tabIndex = changes > 0 ? 0 : -1;
    resetAll.setAttribute("aria-hidden", String(changes === 0));
  };
  return { node, section: { rows, showChanges } };
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
      .map((inner) => withoutPaths(inner, paths))
      .filter((inner) => inner.controls.length > 0 || inner.groups.length > 0),
  };
}
