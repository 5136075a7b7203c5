// The pixel inspector: a click on the picture lists every buffer's value there.

import type { Inspection } from "heliograph/messages.ts";
import type { Viewer } from "../../session/viewer.ts";
import type { PointPicker } from "../../view/picker.ts";
import { bufferLabel } from "./buffer_fields.ts";
import { element, setText } from "../../widgets/element.ts";

const shownDigits = 4;

export function createInspector(viewer: Viewer, host: PointPicker): HTMLElement {
  const rows = element("dl", { class: "pixel-values" });
  const where = element("p", { class: "facts" });
  const toggle = element("input", {
    type: "checkbox",
    role: "switch",
    class: "switch",
    name: "inspect",
    id: "inspect-switch",
    change: () => {
      host.onClick(toggle.checked ? (x, y) => void inspect(x, y) : null);
      if (!toggle.checked) host.unmark();
      setText(where, toggle.checked ? "Click a point of the picture." : "");
      rows.replaceChildren();
    },
  });
  const inspect = async (x: number, y: number): Promise<void> => {
    host.mark(x, y);
    setText(where, "Reading the pixel");
    try {
      show(await viewer.rpc.request<Inspection>("frame.inspect", { x, y }));
    } catch (error) {
      viewer.report(error);
    }
  };
  const show = (inspection: Inspection): void => {
    setText(where, `Pixel ${inspection.column}, ${inspection.row}`);
    rows.replaceChildren(
      ...inspection.buffers.flatMap(({ name, value, unit }) => [
        element("dt", { "data-tip": name }, bufferLabel(name)),
        element("dd", { "data-value": name }, `${value.map(written).join("  ")} ${unit}`.trim()),
      ]),
    );
  };
  const node = element(
    "div",
    { class: "fields inspector", "data-section": "inspector" },
    element(
      "div",
      { class: "row-line" },
      element("label", { class: "row-label", for: toggle.id }, "Inspect pixels"),
      toggle,
    ),
    where,
    rows,
  );
  viewer.capabilities.methods.watch((methods) => (node.hidden = !methods.has("frame.inspect")));
  return node;
}

function written(value: number | null): string {
  if (value === null) return "–";
  return String(Number(value.toPrecision(shownDigits)));
}
