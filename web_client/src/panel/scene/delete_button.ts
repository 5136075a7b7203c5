// Deletes an upload from the list that it is in.

import { deleteUpload } from "../../common/uploads.ts";
import type { Viewer } from "../../session/viewer.ts";
import { confirmButton } from "../../widgets/confirm_button.ts";

/**
 * Part of an entry of a list. The focus goes to the entry that takes its place, or else to the
 * first control around the list.
 */
export function createDeleteButton(
  viewer: Viewer,
  kind: "scene" | "environment" | "image",
  name: string,
): HTMLButtonElement {
  const remove = async (): Promise<void> => {
    const entry = node.parentElement;
    const list = entry?.parentElement;
    if (!list) return;
    const entries = (): HTMLElement[] =>
      [...list.children].filter((child): child is HTMLElement => !(child as HTMLElement).hidden);
    const index = entries().indexOf(entry);
    if (!(await deleteUpload(viewer, kind, name))) return;
    viewer.onInfo(`${name} was deleted`, "upload");
    // Who has gone elsewhere meanwhile stays there.
    if (document.activeElement !== document.body) return;
    const next = entries()[index] ?? entries().at(-1) ?? list.parentElement;
    next?.querySelector<HTMLElement>("button, input, select")?.focus();
  };
  const node = confirmButton(`Delete ${name}`, "close", () => void remove());
  return node;
}
