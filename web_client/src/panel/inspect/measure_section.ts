// Measuring: distances, angles and sizes, in the unit of the session.

import type { Measurement, Snap } from "heliograph/messages.ts";
import { type LengthUnit, describeKind } from "../../session/marks/measurements.ts";
import type { Viewer } from "../../session/viewer.ts";
import type { PointTask, PointTool } from "../../view/point_tool.ts";
import { button, element, setOptions, setText } from "../../widgets/element.ts";
import { field } from "../../widgets/field.ts";

const unitNames: Record<LengthUnit, string> = {
  m: "Metres",
  cm: "Centimetres",
  mm: "Millimetres",
  km: "Kilometres",
  in: "Inches",
  ft: "Feet",
};

interface MeasureSection {
  node: HTMLElement;
  /** Begins or ends measuring distances. */
  toggle(): void;
}

export function createMeasureSection(viewer: Viewer, tool: PointTool): MeasureSection {
  const { measurements } = viewer.marks;
  const distance = createToggle(viewer, tool, "distance");
  const angle = createToggle(viewer, tool, "angle");
  const size = toolButton("Size", () => {
    void measurements.add({ kind: "size", nodes: [...viewer.nodes.selected.value] });
  });
  size.dataset.tip = "Of the selected objects";
  const hint = element("p", { class: "facts", role: "status" });
  const unit = element("select", {
    name: "measure_unit",
    change: () => void measurements.setUnit(unit.value as LengthUnit),
  });
  setOptions(
    unit,
    Object.entries(unitNames).map(([value, label]) => ({ value, label })),
  );
  const list = element("ul", { class: "measurements", "aria-label": "Measurements" });
  const clear = toolButton("Remove all", () => void measurements.clear());
  const controls = element(
    "fieldset",
    { class: "requires-control" },
    element(
      "div",
      { class: "tool-buttons", role: "group", "aria-label": "Measure" },
      distance.node,
      angle.node,
      size,
    ),
    hint,
    field("Unit", unit),
    list,
    clear,
  );
  const show = (): void => {
    const all = viewer.scene.value ? measurements.list.value : [];
    list.hidden = all.length === 0;
    clear.hidden = all.length < 2;
    unit.value = measurements.unit.value;
    showEntries(list, all, (one) => void measurements.remove(one));
  };
  const showHint = (): void => {
    size.disabled = viewer.nodes.selected.value.length === 0;
    setText(hint, hintOf(tool, size.disabled));
  };
  const enable = (): void => {
    controls.disabled = !viewer.membership.mayAnnotate || !viewer.scene.value;
    if (controls.disabled && tool.task.value) tool.stop();
  };
  measurements.list.watch(show);
  measurements.unit.watch(show);
  viewer.scene.watch(() => {
    show();
    enable();
    tool.stop();
  });
  viewer.membership.controlState.watch(enable);
  viewer.nodes.selected.watch(showHint);
  tool.task.watch(showHint);
  tool.points.watch(showHint);
  const node = element(
    "div",
    { class: "fields measure", "data-section": "measure" },
    element("h2", { class: "fields-title" }, "Measure"),
    controls,
  );
  viewer.capabilities.methods.watch((methods) => {
    node.hidden = !methods.has("measurements.add");
  });
  const toggle = (): void => {
    if (!node.hidden && !controls.disabled) distance.toggle();
  };
  return { node, toggle };
}

function createToggle(
  viewer: Viewer,
  tool: PointTool,
  kind: "distance" | "angle",
): { node: HTMLButtonElement; toggle: () => void } {
  const task = taskOf(viewer, kind);
  const toggle = (): void => {
    if (tool.task.value?.name === kind) tool.stop();
    else tool.start(task);
  };
  const node = toolButton(describeKind({ kind }), toggle);
  tool.task.watch((current) => {
    node.setAttribute("aria-pressed", String(current?.name === kind));
  });
  return { node, toggle };
}

function taskOf(viewer: Viewer, kind: "distance" | "angle"): PointTask {
  return {
    name: kind,
    count: kind === "distance" ? 2 : 3,
    repeats: true,
    snaps: true,
    done: (points: Snap[]) => {
      const surfaces = points.map(({ surface }) => ({ surface: surface ?? undefined }));
      void viewer.marks.measurements.add({ kind, points: surfaces });
    },
  };
}

function hintOf(tool: PointTool, nothingSelected: boolean): string {
  const task = tool.task.value;
  if (task?.name !== "distance" && task?.name !== "angle") {
    return nothingSelected ? "Size needs a selected object." : "";
  }
  const names = task.name === "angle" ? ["first", "middle", "last"] : ["first", "second"];
  const next = names[tool.points.value.length];
  const attraction = "Vertices and edges attract it (Alt: neither). Esc ends.";
  return `Click the ${next} point, or P for the middle of the view. ${attraction}`;
}

function toolButton(label: string, click: () => void): HTMLButtonElement {
  return element("button", { type: "button", class: "button quiet", click }, label);
}

/** Keeps the focus in the list when an entry is removed. */
function showEntries(
  list: HTMLUListElement,
  measurements: readonly Measurement[],
  remove: (measurement: Measurement) => void,
): void {
  const focused = [...list.children].findIndex((entry) => entry.contains(document.activeElement));
  list.replaceChildren(
    ...measurements.map((one) =>
      element(
        "li",
        { "data-measurement": String(one.id) },
        element("span", { class: "measurement-kind" }, describeKind(one)),
        element("span", { class: "measurement-value" }, one.text),
        button(`Remove ${describeKind(one).toLowerCase()} ${one.text}`, "close", () => remove(one)),
      ),
    ),
  );
  if (focused < 0) return;
  const entry = list.children[Math.min(focused, list.children.length - 1)];
  entry?.querySelector("button")?.focus();
}
