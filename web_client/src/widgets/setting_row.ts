// One row per setting: its widget, its "changed" marker and its reset button.

import type { JsonValue } from "heliograph/json.ts";
import {
  type ChoiceControl,
  type Control,
  type NumberControl,
  type NumberRange,
  type SliderControl,
  type VectorControl,
  formatNumber,
  parseNumber,
  sliderPosition,
  sliderValue,
} from "heliograph/settings_schema.ts";
import { sameValue } from "heliograph/settings_tree.ts";
import { element, icon, uniqueId } from "./element.ts";

export interface Row {
  node: HTMLElement;
  control: Control;
  /** Shows a value without reporting it back. */
  show(value: JsonValue | undefined, changed: boolean): void;
}

interface Widget {
  /** The element that the label is for; null when the widget labels its parts itself. */
  labelled: HTMLElement | null;
  node: HTMLElement;
  /** A part that is placed below the row instead of beside the label. */
  below?: HTMLElement;
  show(value: JsonValue | undefined): void;
}

type Report = (value: JsonValue) => void;

const sliderSteps = 1000;

/** Longer units are shown in the tooltip, not beside the number. */
const maxSymbolLength = 3;

const unitSymbols: Record<string, string> = {
  seconds: "s",
  second: "s",
  milliseconds: "ms",
  metres: "m",
  meters: "m",
  nanometres: "nm",
  radians: "rad",
  degrees: "°",
  pixels: "px",
  percent: "%",
  stops: "EV",
  kelvin: "K",
  none: "",
  "1": "",
};

function unitSymbol(unit: string): string {
  return unitSymbols[unit] ?? unit;
}

export function createRow(control: Control, report: Report, reset: () => void): Row {
  const widget = createWidget(control, report);
  const id = uniqueId("setting");
  if (widget.labelled) widget.labelled.id = id;
  widget.node.dataset.setting = control.path;
  const label = element(
    widget.labelled ? "label" : "span",
    widget.labelled ? { for: id, class: "row-label" } : { class: "row-label" },
    control.label,
  );
  const resetButton = element(
    "button",
    {
      type: "button",
      class: "reset",
      "aria-label": `Reset ${control.label}`,
      "data-tip": "Reset to default",
      click: reset,
    },
    icon("reset"),
  );
  const node = element(
    "div",
    { class: `row row-${control.kind}`, "data-path": control.path || undefined },
    element("div", { class: "row-line" }, label, resetButton, widget.node),
    widget.below,
  );
  describe(node, control);
  return {
    node,
    control,
    show(value, changed) {
      widget.show(value);
      node.classList.toggle("changed", changed);
      resetButton.tabIndex = changed ? 0 : -1;
      resetButton.setAttribute("aria-hidden", String(!changed));
    },
  };
}

/** The tooltip of a row: help text, then range, default and path. */
function describe(node: HTMLElement, control: Control): void {
  node.dataset.tip = control.description || control.label;
  const unit = unitSymbol(control.unit);
  const facts: string[] = [];
  if (control.kind === "slider") {
    const low = formatNumber(control.minimum, control);
    facts.push(`${low} to ${formatNumber(control.maximum, control)}${unit ? ` ${unit}` : ""}`);
  } else if (unit) {
    facts.push(`in ${control.unit}`);
  }
  if (control.default !== undefined) facts.push(`default ${describeValue(control)}`);
  node.dataset.tipFacts = facts.join(" · ");
  if (control.path) node.dataset.tipPath = control.path;
}

function describeValue(control: Control): string {
  const value = control.default;
  if (typeof value === "boolean") return value ? "on" : "off";
  if (control.kind === "choice") {
    const option = control.options.find((choice) => sameValue(choice.value, value));
    return option?.label ?? String(value);
  }
  if (typeof value === "number" && "step" in control) return formatNumber(value, control);
  return typeof value === "string" ? value || "empty" : JSON.stringify(value);
}

function createWidget(control: Control, report: Report): Widget {
  switch (control.kind) {
    case "toggle":
      return toggle(report);
    case "slider":
      return slider(control, report);
    case "number":
      return number(control, report);
    case "vector":
      return vector(control, report);
    case "choice":
      return choice(control, report);
    case "text":
      return text(report);
    case "color":
      return color(report);
    case "json":
      return json(report);
  }
}

function toggle(report: Report): Widget {
  const input = element("input", {
    type: "checkbox",
    role: "switch",
    class: "switch",
    change: () => report(input.checked),
  });
  return { labelled: input, node: input, show: (value) => (input.checked = value === true) };
}

function slider(control: SliderControl, report: Report): Widget {
  const entry = numberEntry(control, control.unit, report, control.label);
  const track = element("input", {
    type: "range",
    min: "0",
    max: String(sliderSteps),
    step: "1",
    "aria-label": control.label,
    input: () => {
      const value = sliderValue(control, Number(track.value) / sliderSteps);
      fill();
      entry.show(value);
      report(value);
    },
    keydown: (event: KeyboardEvent) => {
      const direction = arrowDirection(event);
      if (!direction) return;
      event.preventDefault();
      report(stepped(control, shown, direction));
    },
  });
  let shown = 0;
  const fill = (): void => {
    track.style.setProperty("--filled", `${(Number(track.value) / sliderSteps) * 100}%`);
  };
  return {
    labelled: entry.input,
    node: entry.node,
    below: track,
    show(value) {
      entry.show(value);
      shown = Number(value ?? control.minimum);
      track.value = String(Math.round(sliderPosition(control, shown) * sliderSteps));
      const valueText = `${formatNumber(shown, control)} ${control.unit}`.trim();
      track.setAttribute("aria-valuetext", valueText);
      fill();
    },
  };
}

function arrowDirection(event: KeyboardEvent): number {
  if (event.key === "ArrowRight" || event.key === "ArrowUp") return event.shiftKey ? 10 : 1;
  if (event.key === "ArrowLeft" || event.key === "ArrowDown") return event.shiftKey ? -10 : -1;
  return 0;
}

/** The next value on the control's grid; on a non-linear scale, a step is 1 % of the track. */
function stepped(control: SliderControl, value: number, steps: number): number {
  if (control.scale === "linear") {
    return parseNumber(String(value + steps * control.step), control) ?? value;
  }
  const next = sliderValue(control, sliderPosition(control, value) + steps / 100);
  return next === value ? value + Math.sign(steps) * control.step : next;
}

function number(control: NumberControl, report: Report): Widget {
  const entry = numberEntry(control, control.unit, report, control.label);
  return { labelled: entry.input, node: entry.node, show: entry.show };
}

function vector(control: VectorControl, report: Report): Widget {
  const values: number[] = new Array<number>(control.length).fill(0);
  const names = control.length <= 4 ? ["x", "y", "z", "w"] : [];
  const entries = values.map((_, index) =>
    numberEntry(
      control,
      "",
      (value) => {
        values[index] = Number(value);
        report([...values]);
      },
      `${control.label} ${names[index] ?? index + 1}`,
    ),
  );
  const group = element("div", { class: "vector", role: "group", "aria-label": control.label });
  group.append(...entries.map((entry) => entry.node));
  const empty = element("span");
  return {
    labelled: null,
    node: empty,
    below: group,
    show(value) {
      if (!Array.isArray(value)) return;
      entries.forEach((entry, index) => {
        values[index] = Number(value[index] ?? 0);
        entry.show(values[index]);
      });
    },
  };
}

function choice(control: ChoiceControl, report: Report): Widget {
  const select = element(
    "select",
    { change: () => report(control.options[select.selectedIndex]?.value ?? null) },
    ...control.options.map(({ value, label }) =>
      element("option", { value: String(value) }, label),
    ),
  );
  return {
    labelled: select,
    node: select,
    show(value) {
      select.selectedIndex = control.options.findIndex((option) => sameValue(option.value, value));
    },
  };
}

function text(report: Report): Widget {
  const input = element("input", {
    type: "text",
    spellcheck: "false",
    autocomplete: "off",
    change: () => report(input.value),
  });
  return {
    labelled: input,
    node: input,
    show: (value) => {
      if (document.activeElement !== input) input.value = String(value ?? "");
    },
  };
}

function color(report: Report): Widget {
  const input = element("input", { type: "color", class: "color", input: () => report(input.value) });
  return { labelled: input, node: input, show: (value) => (input.value = String(value ?? "")) };
}

function json(report: Report): Widget {
  let shown: JsonValue | undefined;
  const input = element("input", {
    type: "text",
    spellcheck: "false",
    autocomplete: "off",
    change: () => {
      try {
        report(JSON.parse(input.value) as JsonValue);
      } catch {
        input.value = JSON.stringify(shown ?? null);
      }
    },
  });
  return {
    labelled: input,
    node: input,
    show(value) {
      shown = value;
      if (document.activeElement !== input) input.value = JSON.stringify(value ?? null);
    },
  };
}

/** A number input with its unit; arrow keys step it, invalid input restores the value. */
function numberEntry(range: NumberRange, unit: string, report: Report, label: string) {
  let shown = 0;
  const write = (): void => {
    input.value = formatNumber(shown, range);
  };
  const accept = (value: number | null): void => {
    if (value === null) {
      write();
      return;
    }
    shown = value;
    write();
    report(value);
  };
  const input = element("input", {
    type: "text",
    inputmode: "decimal",
    autocomplete: "off",
    class: "number",
    "aria-label": unit ? `${label}, ${unit}` : label,
    change: () => accept(parseNumber(input.value, range)),
    focus: () => input.select(),
    keydown: (event: KeyboardEvent) => {
      if (event.key === "Escape") write();
      if (event.key !== "ArrowUp" && event.key !== "ArrowDown") return;
      event.preventDefault();
      const steps = arrowDirection(event);
      accept(parseNumber(formatNumber(shown + steps * range.step, range), range));
    },
  });
  const symbol = unitSymbol(unit);
  const node = element("span", { class: "entry" }, input);
  if (symbol && symbol.length <= maxSymbolLength) {
    node.classList.add("with-unit");
    node.append(element("span", { class: "unit", "aria-hidden": "true" }, symbol));
  }
  return {
    node,
    input,
    show(value: JsonValue | undefined): void {
      shown = Number(value ?? 0);
      if (document.activeElement !== input || Number(input.value) !== shown) write();
    },
  };
}
