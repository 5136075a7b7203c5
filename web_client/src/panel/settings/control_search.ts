// Finds controls of the other tabs: the search of the Settings tab covers the whole panel.

import { element, icon } from "../../widgets/element.ts";

const highlightMs = 1600;

/** Lists the controls whose labels contain all words. Returns their number. */
export function findControls(
  list: HTMLElement,
  typed: string,
  showTab: (id: string) => void,
): number {
  const words = typed.toLowerCase().split(/\s+/).filter(Boolean);
  const tab = list.closest("[data-tab]");
  const pages = [...(tab?.parentElement?.querySelectorAll("[data-tab]") ?? [])];
  const found =
    words.length === 0
      ? []
      : pages
          .filter((page) => page !== tab)
          .flatMap((page) => [...page.querySelectorAll<HTMLElement>(".row, .field")])
          .filter((row) => isOffered(row) && words.every((word) => textOf(row).includes(word)));
  list.hidden = found.length === 0;
  list.replaceChildren(...found.map((row) => resultFor(row, showTab)));
  return found.length;
}

const labelOf = (row: HTMLElement): string =>
  row.querySelector("label, .row-label")?.textContent?.trim() ?? "";

const titleOf = (row: HTMLElement): string =>
  row.closest(".section")?.querySelector("h2")?.textContent ?? "";

function textOf(row: HTMLElement): string {
  const { tip, path } = row.dataset;
  return `${labelOf(row)} ${titleOf(row)} ${tip ?? ""} ${path ?? ""}`.toLowerCase();
}

/** Whether the control exists for this scene; its tab may be hidden. */
function isOffered(row: HTMLElement): boolean {
  const hidden = row.closest("[hidden]");
  return labelOf(row) !== "" && (hidden === null || hidden.matches("[data-tab]"));
}

function resultFor(row: HTMLElement, showTab: (id: string) => void): HTMLElement {
  const tab = row.closest<HTMLElement>("[data-tab]")?.dataset.tab ?? "";
  const place = [document.getElementById(`tab-${tab}`)?.textContent, titleOf(row)];
  return element(
    "button",
    { type: "button", class: "found", click: () => reveal(row, tab, showTab) },
    element("span", {}, labelOf(row)),
    element("small", {}, place.filter(Boolean).join(" › ")),
    icon("chevron"),
  );
}

/** Shows the control in its tab, and moves the focus to it. */
function reveal(row: HTMLElement, tab: string, showTab: (id: string) => void): void {
  showTab(tab);
  const fold = row.closest("details");
  if (fold) fold.open = true;
  row.scrollIntoView({ block: "center" });
  row.querySelector<HTMLElement>("input, select, button:not(.reset)")?.focus();
  row.classList.add("revealed");
  setTimeout(() => row.classList.remove("revealed"), highlightMs);
}
