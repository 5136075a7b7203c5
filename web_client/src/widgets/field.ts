// A labelled control that is not generated from the settings' schema.

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
