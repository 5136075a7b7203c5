// A button for what cannot be undone.

import { button, icon } from "./element.ts";

/**
 * Asks before it acts: the second click confirms, unless it is that of a double click, and leaving
 * it takes the question back.
 */
export function confirmButton(
  label: string,
  iconName: string,
  action: () => void,
): HTMLButtonElement {
  let asks = false;
  const ask = (now: boolean): void => {
    if (asks === now) return;
    asks = now;
    const question = `Confirm: ${label.charAt(0).toLowerCase()}${label.slice(1)}`;
    node.setAttribute("aria-label", asks ? question : label);
    node.replaceChildren(asks ? `${label.split(" ", 1)}?` : icon(iconName));
    node.classList.toggle("confirms", asks);
  };
  const node = button(label, iconName, ({ detail }) => {
    if (asks && detail > 1) return; // a key counts as 0 clicks
    const confirmed = asks;
    ask(!asks);
    if (confirmed) action();
  });
  node.addEventListener("blur", () => ask(false));
  return node;
}
