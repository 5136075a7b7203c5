// Finds controls of the whole page, which the search of the Advanced tab covers: rows and buttons of
// the tabs, and what stands outside them.

import { element, icon } from "../../widgets/element.ts";

const highlightMs = 1600;
const rowSelector = ".row, .field, .fields > .row-line";
const outsideSelector = [
  "#panel > header button",
  "#top-left > div > button",
  "#transport button",
  "#transport select",
  "#transport input",
].join();

/** Lists the controls whose texts contain all words. Returns their number. */
export function findControls(
  list: HTMLElement,
  typed: string,
  showTab: (id: string) => void,
): number {
  const words = typed.toLowerCase().split(/\s+/).filter(Boolean);
  const found =
    words.length === 0
      ? []
      : allControls(list).filter((control) => {
          const text = textOf(control);
          return isOffered(control) && words.every((word) => text.includes(word));
        });
  list.hidden = found.length === 0;
  list.replaceChildren(...found.map((control) => resultFor(control, showTab)));
  return found.length;
}

/** All but the settings that the search filters where they are, and the list of results. */
function allControls(list: HTMLElement): HTMLElement[] {
  const own = list.closest("[data-tab]");
  const pages = [...(own?.parentElement?.querySelectorAll("[data-tab]") ?? [])];
  const inside = pages.flatMap((page) => {
    const buttons = [...page.querySelectorAll<HTMLElement>("button:not(.found)")];
    const alone = buttons.filter((node) => !node.closest(rowSelector));
    return page === own ? alone : [...page.querySelectorAll<HTMLElement>(rowSelector), ...alone];
  });
  return [...inside, ...document.querySelectorAll<HTMLElement>(outsideSelector)];
}

function labelOf(control: HTMLElement): string {
  const label = control.querySelector("label, .row-label");
  return (label?.textContent ?? control.getAttribute("aria-label") ?? control.textContent ?? "").trim();
}

const titleOf = (control: HTMLElement): string =>
  control.closest(".section")?.querySelector("h2")?.textContent ?? "";

function textOf(control: HTMLElement): string {
  const { tip, path } = control.dataset;
  const parts = [...control.querySelectorAll("button, input, select")].map(
    (part) => `${part.getAttribute("aria-label") ?? part.textContent}`,
  );
  const texts = [labelOf(control), titleOf(control), tip ?? "", path ?? "", ...parts];
  return texts.join(" ").toLowerCase();
}

/** Whether the control exists for this scene; its tab or menu may be closed. */
function isOffered(control: HTMLElement): boolean {
  const hidden = control.closest("[hidden]");
  return labelOf(control) !== "" && (hidden === null || hidden.matches("[data-tab], [role=menu]"));
}

function resultFor(control: HTMLElement, showTab: (id: string) => void): HTMLElement {
  const tab = control.closest<HTMLElement>("[data-tab]")?.dataset.tab;
  const place = [tab && document.getElementById(`tab-${tab}`)?.textContent, titleOf(control)];
  const menu = control.closest("[role=menu]")?.getAttribute("aria-label");
  return element(
    "button",
    { type: "button", class: "found", click: () => reveal(control, tab, showTab) },
    element("span", {}, labelOf(control)),
    element("small", {}, [...place, menu].filter(Boolean).join(" › ")),
    icon("chevron"),
  );
}

/** Shows the control where it is, and moves the focus to it. */
function reveal(
  control: HTMLElement,
  tab: string | undefined,
  showTab: (id: string) => void,
): void {
  if (tab !== undefined) showTab(tab);
  const menu = control.closest<HTMLElement>("[role=menu]");
  if (menu?.hidden) menu.parentElement?.querySelector("button")?.click();
  const fold = control.closest("details");
  if (fold) fold.open = true;
  control.scrollIntoView({ block: "center" });
  const inner = control.querySelector<HTMLElement>("input, select, button:not(.reset)");
  (inner ?? control).focus();
  control.classList.add("revealed");
  setTimeout(() => control.classList.remove("revealed"), highlightMs);
}
