// Looking into the renderer: its buffers one by one.

import type { Viewer } from "../viewer.ts";
import { createBufferFields } from "./buffer_fields.ts";
import { element } from "./element.ts";

export function createInspectTab(viewer: Viewer): HTMLElement {
  return element(
    "div",
    {},
    element("div", { class: "fields", "data-section": "buffers" }, ...createBufferFields(viewer)),
  );
}
