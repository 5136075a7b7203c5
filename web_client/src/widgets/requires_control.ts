// Parts of the page that change what all viewers see: out of use, visibly, for who may not.

import type { Viewer } from "../session/viewer.ts";
import { element } from "./element.ts";

/** Wraps controls so that all of them are disabled while this page may change nothing. */
export function requiresControl(viewer: Viewer, ...controls: HTMLElement[]): HTMLFieldSetElement {
  const set = element("fieldset", { class: "requiresControl" }, ...controls);
  viewer.controlState.watch(({ kind }) => {
    set.disabled = kind !== "may_change";
    for (const node of set.querySelectorAll("[role=slider]")) {
      node.setAttribute("aria-disabled", String(set.disabled));
    }
  });
  return set;
}

/** For what is no form control: whether it stands among disabled ones. */
export function isDisabled(node: Element): boolean {
  return node.closest("fieldset:disabled") !== null;
}
