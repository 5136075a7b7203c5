// A button that opens a list of actions (ARIA menu button).

import { button, element, icon, setText } from "./element.ts";

export interface MenuItem {
  label: string;
  icon: string;
  run: () => void;
  /** Whether the item is shown now; always if left out. */
  isAvailable?: () => boolean;
  /** The label now, where it changes. */
  currentLabel?: () => string;
}

export function createMenu(label: string, iconName: string, items: MenuItem[]): HTMLElement {
  const list = element("div", { class: "menu", role: "menu", "aria-label": label, hidden: true });
  const entries = items.map((item) => {
    const text = element("span", {}, item.label);
    const node = element(
      "button",
      {
        type: "button",
        role: "menuitem",
        tabindex: "-1",
        click: () => {
          close(true);
          item.run();
        },
      },
      icon(item.icon),
      text,
    );
    list.append(node);
    return { node, text, item };
  });
  const opener = button(label, iconName, () => (list.hidden ? open() : close(true)));
  opener.setAttribute("aria-haspopup", "menu");
  opener.setAttribute("aria-expanded", "false");
  const open = (): void => {
    for (const { node, text, item } of entries) {
      node.hidden = item.isAvailable ? !item.isAvailable() : false;
      if (item.currentLabel) setText(text, item.currentLabel());
    }
    list.hidden = false;
    opener.setAttribute("aria-expanded", "true");
    focusEntry(0);
  };
  const close = (focusOpener: boolean): void => {
    if (list.hidden) return;
    list.hidden = true;
    opener.setAttribute("aria-expanded", "false");
    if (focusOpener) opener.focus();
  };
  const focusEntry = (index: number): void => {
    const shown = entries.filter(({ node }) => !node.hidden);
    shown[(index + shown.length) % shown.length]?.node.focus();
  };
  list.addEventListener("keydown", (event) => {
    const shown = entries.filter(({ node }) => !node.hidden).map(({ node }) => node);
    const at = shown.indexOf(document.activeElement as HTMLButtonElement);
    const target = { ArrowDown: at + 1, ArrowUp: at - 1, Home: 0, End: -1 }[event.key];
    if (event.key === "Escape") close(true);
    else if (target !== undefined) focusEntry(target);
    else return;
    event.preventDefault();
    event.stopPropagation();
  });
  const box = element("div", { class: "menu-box" }, opener, list);
  addEventListener("pointerdown", (event) => {
    if (!box.contains(event.target as Node)) close(false);
  });
  box.addEventListener("focusout", (event) => {
    if (event.relatedTarget && !box.contains(event.relatedTarget as Node)) close(false);
  });
  return box;
}
