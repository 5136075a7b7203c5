// The Inspect tab: buffers, comparison, pixel values.

import type { Comparison } from "../../compare/comparison.ts";
import type { Viewer } from "../../session/viewer.ts";
import type { Divider } from "../../view/divider.ts";
import type { PointPicker } from "../../view/picker.ts";
import { element } from "../../widgets/element.ts";
import { requiresControl } from "../../widgets/requires_control.ts";
import { createBufferFields } from "./buffer_fields.ts";
import { createCompareFields } from "./compare_fields.ts";
import { createInspector } from "./pixel_inspector.ts";

export interface InspectParts {
  comparison: Comparison;
  divider: Divider;
  picker: PointPicker;
}

export function createInspectTab(viewer: Viewer, parts: InspectParts): HTMLElement {
  return element(
    "div",
    {},
    requiresControl(
      viewer,
      element("div", { class: "fields", "data-section": "buffers" }, ...createBufferFields(viewer)),
    ),
    createCompareFields(viewer, parts.comparison, parts.divider),
    createInspector(viewer, parts.picker),
  );
}
