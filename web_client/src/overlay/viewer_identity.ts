// How other viewers are told apart: by a name and a colour.

import { viewerName } from "../session/control_state.ts";
import type { Viewer } from "../session/viewer.ts";

const hueCount = 10;

/** The name of a viewer of the scene; one without has the number of its line in the list. */
export function nameOfViewer({ membership, company }: Viewer, id: string): string {
  const all = [...(membership.session.value?.viewers ?? []), ...company.elsewhere.value];
  const index = all.findIndex(({ viewer }) => viewer === id);
  const found = all[index];
  return found ? viewerName(found, index) : "A viewer";
}

/** A CSS colour; ids are "v1", "v2" and so on. */
export function colourOfViewer(id: string): string {
  return `var(--hue-${(Number(id.replace(/\D/g, "")) || 0) % hueCount})`;
}
