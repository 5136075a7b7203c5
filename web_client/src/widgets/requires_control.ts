// Controls that change the session: disabled while this page is not in control.

import type { Viewer } from "../session/viewer.ts";
import { element } from "./element.ts";

/** Wraps controls that are disabled while this page may not change the session. */
export function requiresControl(viewer: Viewer, ...controls: HTMLElement[]): HTMLFieldSetElement {
  const set = element("fieldset", { class: "requires-control" }, ...controls);
  viewer.membership.controlState.watch(({ kind }) => {
    set.disabled = kind !== "may_change";
    for (const node of set.querySelectorAll("[role=slider]")) {
      node.setAttribute("aria-disabled", String(set.disabled));
    }
  });
  return set;
}

/** Whether an element that is no form control is inside a disabled fieldset. */
export function isDisabled(node: Element): boolean {
  return node.closest("fieldset:disabled") !== null;
}
