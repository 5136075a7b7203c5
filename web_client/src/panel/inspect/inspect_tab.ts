// The Inspect tab: buffers, comparison, pixel values.

import type { Comparison } from "../../compare/comparison.ts";
import type { Viewer } from "../../session/viewer.ts";
import type { Divider } from "../../view/divider.ts";
import type { PointPicker } from "../../view/picker.ts";
import type { PointTool } from "../../view/point_tool.ts";
import { element } from "../../widgets/element.ts";
import { requiresControl } from "../../widgets/requires_control.ts";
import { createAnnotateSection } from "./annotate_section.ts";
import { createBufferFields } from "./buffer_fields.ts";
import { createCompareFields } from "./compare_fields.ts";
import { createMeasureSection } from "./measure_section.ts";
import { createInspector } from "./pixel_inspector.ts";

export interface InspectParts {
  comparison: Comparison;
  divider: Divider;
  picker: PointPicker;
  /** Places points to measure between. */
  points: PointTool;
}

interface InspectTab {
  node: HTMLElement;
  /** Begins or ends measuring distances. */
  toggleMeasuring(): void;
  /** Begins or ends choosing a place for an annotation. */
  toggleAnnotating(): void;
}

export function createInspectTab(viewer: Viewer, parts: InspectParts): InspectTab {
  const measure = createMeasureSection(viewer, parts.points);
  const annotate = createAnnotateSection(viewer, parts.points);
  const node = element(
    "div",
    {},
    measure.node,
    annotate.node,
    requiresControl(
      viewer,
      element("div", { class: "fields", "data-section": "buffers" }, ...createBufferFields(viewer)),
    ),
    createCompareFields(viewer, parts.comparison, parts.divider),
    createInspector(viewer, parts.picker),
  );
  return { node, toggleMeasuring: measure.toggle, toggleAnnotating: annotate.toggle };
}
