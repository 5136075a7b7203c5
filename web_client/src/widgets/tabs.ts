// Tabs; arrow keys move between them (ARIA authoring practices).

import { preferences } from "../common/preferences.ts";
import { element, icon } from "./element.ts";

interface TabParts {
  id: string;
  label: string;
  icon: string;
  body: HTMLElement;
}

interface Tabs {
  list: HTMLElement;
  pages: HTMLElement;
  select(id: string): void;
}

const storageKey = "tab";

export function createTabs(label: string, parts: TabParts[]): Tabs {
  const pages = element("div", { class: "panel-content", id: "panel-content" });
  const list = element("div", { class: "tabs", role: "tablist", "aria-label": label });
  const tabs = parts.map((part, index) => {
    const tab = element(
      "button",
      {
        type: "button",
        role: "tab",
        id: `tab-${part.id}`,
        class: "tab",
        "aria-controls": `page-${part.id}`,
        click: () => show(index),
        keydown: (event: KeyboardEvent) => move(event, index),
      },
      icon(part.icon),
      element("span", {}, part.label),
    );
    const page = element(
      "div",
      {
        role: "tabpanel",
        id: `page-${part.id}`,
        class: "page",
        "aria-labelledby": tab.id,
        "data-tab": part.id,
      },
      part.body,
    );
    list.append(tab);
    pages.append(page);
    return { tab, page, id: part.id };
  });
  const show = (active: number): void => {
    tabs.forEach(({ tab, page, id }, index) => {
      const selected = index === active;
      tab.setAttribute("aria-selected", String(selected));
      tab.tabIndex = selected ? 0 : -1;
      page.hidden = !selected;
      if (selected) preferences.setText(storageKey, id);
    });
    pages.scrollTop = 0;
  };
  const move = (event: KeyboardEvent, index: number): void => {
    const target = { ArrowRight: index + 1, ArrowLeft: index - 1, Home: 0, End: -1 }[event.key];
    if (target === undefined) return;
    event.preventDefault();
    const next = (target + tabs.length) % tabs.length;
    show(next);
    tabs[next]?.tab.focus();
  };
  const select = (id: string): void => {
    show(
      Math.max(
        0,
        tabs.findIndex((tab) => tab.id === id),
      ),
    );
  };
  select(preferences.text(storageKey, parts[0]?.id ?? ""));
  return { list, pages, select };
}
