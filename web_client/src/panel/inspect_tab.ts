// Looking into the renderer: its buffers, two ways of rendering side by side, single pixels.

import type { Comparison } from "../compare.ts";
import type { Divider } from "../view/divider.ts";
import type { Viewer } from "../viewer.ts";
import { createBufferFields } from "./buffer_fields.ts";
import { changeable } from "./changeable.ts";
import { createCompareFields } from "./compare_fields.ts";
import { element } from "./element.ts";
import { type InspectorHost, createInspector } from "./inspector.ts";

export interface InspectParts {
  comparison: Comparison;
  divider: Divider;
  inspector: InspectorHost;
}

export function createInspectTab(viewer: Viewer, parts: InspectParts): HTMLElement {
  return element(
    "div",
    {},
    changeable(
      viewer,
      element("div", { class: "fields", "data-section": "buffers" }, ...createBufferFields(viewer)),
    ),
    createCompareFields(viewer, parts.comparison, parts.divider),
    createInspector(viewer, parts.inspector),
  );
}
