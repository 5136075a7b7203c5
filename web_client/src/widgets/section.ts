// A foldable section of the panel that remembers whether it was open.

import { preferences } from "../common/preferences.ts";
import { element, icon } from "./element.ts";

export interface SectionParts {
  /** Identifies the section between visits. */
  id: string;
  title: string;
  body: HTMLElement;
  openAtFirst: boolean;
  /** A quiet text at the right of the title. */
  note?: HTMLElement;
  /** A button in the header's corner; beside the fold switch, not inside it. */
  action?: HTMLElement;
}

export function createSection(parts: SectionParts): HTMLElement {
  const key = `open.${parts.id}`;
  const fold = element(
    "details",
    {
      open: preferences.flag(key, parts.openAtFirst),
      toggle: () => preferences.setFlag(key, fold.open),
    },
    element("summary", {}, icon("chevron"), element("h2", {}, parts.title), parts.note),
    parts.body,
  );
  return element(
    "section",
    { class: "section", "data-section": parts.id },
    fold,
    parts.action,
  );
}
