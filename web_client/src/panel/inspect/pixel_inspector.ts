// The pixel inspector: a click on the view lists the value of every buffer there.

import type { Inspection, Pick } from "heliograph/messages.ts";
import type { Viewer } from "../../session/viewer.ts";
import type { PointPicker } from "../../view/picker.ts";
import { element, setText } from "../../widgets/element.ts";
import { bufferLabel } from "./buffer_fields.ts";

const shownDigits = 4;

export function createInspector(viewer: Viewer, picker: PointPicker): HTMLElement {
  const rows = element("dl", { class: "pixel-values" });
  const position = element("p", { class: "facts" });
  const toggle = element("input", {
    type: "checkbox",
    role: "switch",
    class: "switch",
    name: "inspect",
    id: "inspect-switch",
    change: () => {
      picker.onClick(toggle.checked ? (x, y) => void inspect(x, y) : null);
      if (!toggle.checked) picker.unmark();
      setText(position, toggle.checked ? "Click a point in the view." : "");
      rows.replaceChildren();
    },
  });
  const inspect = async (x: number, y: number): Promise<void> => {
    picker.mark(x, y);
    setText(position, "Reading the pixel values");
    try {
      const [inspection, surface] = await Promise.all([
        viewer.queries.inspect(x, y),
        viewer.queries.pick(x, y),
      ]);
      show(inspection, surface);
    } catch (error) {
      viewer.report(error);
    }
  };
  const show = (inspection: Inspection, surface: Pick | null): void => {
    setText(position, `Pixel ${inspection.column}, ${inspection.row}`);
    rows.replaceChildren(
      ...describeSurface(surface).flatMap(([name, value]) => [
        element("dt", {}, name),
        element("dd", { "data-surface": name.toLowerCase() }, value),
      ]),
      ...inspection.buffers.flatMap(({ name, value, unit }) => [
        element("dt", { "data-tip": name }, bufferLabel(name)),
        element(
          "dd",
          { "data-value": name },
          `${value.map(formatValue).join("  ")} ${unit}`.trim(),
        ),
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
    position,
    rows,
  );
  viewer.capabilities.methods.watch((methods) => (node.hidden = !methods.has("frame.inspect")));
  return node;
}

/** What is there, before the values of buffers. */
function describeSurface(surface: Pick | null): [name: string, value: string][] {
  if (!surface) return [["Object", "None: the background"]];
  const { object, material, position, distance } = surface;
  return [
    ["Object", object ?? "Without a name"],
    ["Material", material ?? "Without a name"],
    ["Position", `${position?.map(formatValue).join("  ") ?? "–"} m`],
    ["Distance", `${formatValue(distance)} m`],
  ];
}

function formatValue(value: number | null): string {
  if (value === null) return "–";
  return String(Number(value.toPrecision(shownDigits)));
}
