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
