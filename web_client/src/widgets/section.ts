// A collapsible section of the panel. Its state is stored in the preferences.

import { preferences } from "../common/preferences.ts";
import { element, icon } from "./element.ts";

interface SectionParts {
  /** Identifies the section in the preferences. */
  id: string;
  title: string;
  body: HTMLElement;
  openByDefault: boolean;
  /** A text at the right of the title. */
  note?: HTMLElement;
  /** A button in the header's corner, beside the toggle. */
  action?: HTMLElement;
}

/** Reports whether a section's body can be seen: unfolded, in the tab and the panel that are shown. */
export function watchUnfolded(section: HTMLElement, report: (unfolded: boolean) => void): void {
  const fold = section.querySelector("details");
  const update = (): void => report(fold?.open === true && section.getClientRects().length > 0);
  fold?.addEventListener("toggle", update);
  new ResizeObserver(update).observe(section);
}

export function createSection(parts: SectionParts): HTMLElement {
  const key = `open.${parts.id}`;
  const fold = element(
    "details",
    {
      open: preferences.flag(key, parts.openByDefault),
      toggle: () => preferences.setFlag(key, fold.open),
    },
    element("summary", {}, icon("chevron"), element("h2", {}, parts.title), parts.note),
    parts.body,
  );
  return element("section", { class: "section", "data-section": parts.id }, fold, parts.action);
}
