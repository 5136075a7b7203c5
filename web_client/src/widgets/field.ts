// A labelled control of the hand-made part of the panel.

import { element, uniqueId } from "./element.ts";

export function field(
  label: string,
  control: HTMLElement,
  ...beside: (HTMLElement | null)[]
): HTMLElement {
  const id = uniqueId("field");
  control.id = id;
  return element(
    "div",
    { class: "field" },
    element("label", { for: id }, label),
    element("div", { class: "field-controls" }, control, ...beside),
  );
}
