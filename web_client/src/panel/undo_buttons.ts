// Undo and redo, whose labels name the step: "Undo: exposure (Ctrl Z)".

import type { Viewer } from "../session/viewer.ts";
import { button } from "../widgets/element.ts";

export function createUndoButtons(viewer: Viewer): HTMLButtonElement[] {
  const undo = button("Undo", "undo", () => viewer.undo());
  const redo = button("Redo", "redo", () => viewer.redo());
  const update = (): void => {
    const next = viewer.history.next.value;
    describe(undo, "Undo", "Ctrl Z", next.undo, viewer.mayChange);
    describe(redo, "Redo", "Ctrl Shift Z", next.redo, viewer.mayChange);
  };
  viewer.history.next.watch(update);
  viewer.membership.controlState.watch(update);
  return [undo, redo];
}

/** A disabled button keeps the focus, so that its keys go on working. */
function describe(
  node: HTMLButtonElement,
  action: string,
  keys: string,
  step: string | null,
  enabled: boolean,
): void {
  const label = `${step === null ? action : `${action}: ${step}`} (${keys})`;
  node.setAttribute("aria-label", label);
  node.dataset.tip = label;
  node.setAttribute("aria-disabled", String(!enabled || step === null));
}
