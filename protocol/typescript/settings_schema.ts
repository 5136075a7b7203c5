// Turns the JSON Schema of the settings into a description of controls. It contains no names of
// settings, so a setting that is added to the server needs no change here.

import type { JsonObject, JsonValue } from "./json.ts";
import { isObject } from "./settings_tree.ts";

/** Integers with a wider range, such as a random seed, get a number field instead of a slider. */
const maxIntegerSliderRange = 1_000_000;

/** Labels of names that are not plain words. */
const properNames: Record<string, string> = {
  aces: "ACES",
  agx: "AgX",
  gbuffer: "G-buffer",
  ibl: "IBL",
  taa: "TAA",
};

interface ControlBase {
  /** Dotted path of the setting. */
  path: string;
  label: string;
  description: string;
  /** As in the schema, for example "seconds"; empty without a unit. */
  unit: string;
  default: JsonValue | undefined;
  order: number;
}

export interface NumberRange {
  minimum: number | undefined;
  maximum: number | undefined;
  step: number;
  integer: boolean;
}

/** The mapping from a slider's position to its value. */
type SliderScale = "linear" | "logarithmic" | "cubic";

export interface ToggleControl extends ControlBase {
  kind: "toggle";
}
export interface SliderControl extends ControlBase, NumberRange {
  kind: "slider";
  minimum: number;
  maximum: number;
  scale: SliderScale;
}
export interface NumberControl extends ControlBase, NumberRange {
  kind: "number";
}
export interface VectorControl extends ControlBase, NumberRange {
  kind: "vector";
  length: number;
}
export interface ChoiceControl extends ControlBase {
  kind: "choice";
  options: { value: JsonValue; label: string }[];
}
export interface TextControl extends ControlBase {
  kind: "text";
}
/** "#rrggbb" */
export interface ColorControl extends ControlBase {
  kind: "color";
}
/** A type without a widget: edited as JSON text. */
export interface JsonControl extends ControlBase {
  kind: "json";
}

export type Control =
  | ToggleControl
  | SliderControl
  | NumberControl
  | VectorControl
  | ChoiceControl
  | TextControl
  | ColorControl
  | JsonControl;

export interface ControlGroup {
  path: string;
  title: string;
  description: string;
  order: number;
  controls: Control[];
  groups: ControlGroup[];
}

/** Describes the whole panel. The result is an unnamed group that holds the top-level ones. */
export function describeControls(schema: JsonObject): ControlGroup {
  return describeGroup(schema, schema, "", "", 0);
}

/** Every default of the schema, as a settings tree. */
export function defaultTree(group: ControlGroup): JsonObject {
  const tree: JsonObject = {};
  for (const control of group.controls) {
    if (control.default !== undefined) tree[lastName(control.path)] = control.default;
  }
  for (const inner of group.groups) tree[lastName(inner.path)] = defaultTree(inner);
  return tree;
}

export function allControls(group: ControlGroup): Control[] {
  return [...group.controls, ...group.groups.flatMap(allControls)];
}

/** "max_history" -> "Max history". */
export function humanise(name: string): string {
  const words = name.split(/[_ ]+/).map((word) => properNames[word] ?? word);
  const sentence = words.join(" ").trim();
  return sentence.charAt(0).toUpperCase() + sentence.slice(1);
}

function describeGroup(
  root: JsonObject,
  schema: JsonObject,
  path: string,
  title: string,
  order: number,
): ControlGroup {
  const group: ControlGroup = {
    path,
    title,
    description: text(schema.description),
    order,
    controls: [],
    groups: [],
  };
  const properties = isObject(schema.properties) ? schema.properties : {};
  Object.entries(properties).forEach(([name, value], index) => {
    const node = resolve(root, value);
    const inner = path ? `${path}.${name}` : name;
    const label = text(node.title) || humanise(name);
    const position = typeof node["x-order"] === "number" ? node["x-order"] : index;
    if (isObject(node.properties)) {
      group.groups.push(describeGroup(root, node, inner, label, position));
    } else {
      group.controls.push(describeControl(node, inner, label, position));
    }
  });
  group.controls.sort((a, b) => a.order - b.order);
  group.groups = group.groups
    .filter((inner) => inner.controls.length > 0 || inner.groups.length > 0)
    .sort((a, b) => a.order - b.order);
  return group;
}

function describeControl(node: JsonObject, path: string, label: string, order: number): Control {
  const base: ControlBase = {
    path,
    label,
    description: text(node.description),
    unit: text(node["x-unit"]),
    default: node.default,
    order,
  };
  const type = typeOf(node);
  if (Array.isArray(node.enum) && node.enum.length > 0) {
    const labels = isObject(node["x-labels"]) ? node["x-labels"] : {};
    const options = node.enum
      .filter((value) => value !== null)
      .map((value) => ({ value, label: text(labels[String(value)]) || humanise(String(value)) }));
    return { ...base, kind: "choice", options };
  }
  if (type === "boolean") return { ...base, kind: "toggle" };
  if (type === "string") return { ...base, kind: node.format === "color" ? "color" : "text" };
  if (type === "number" || type === "integer") return describeNumber(base, node, type);
  if (type === "array") {
    const items = isObject(node.items) ? node.items : {};
    const itemType = typeOf(items);
    const length = vectorLength(node);
    if ((itemType === "number" || itemType === "integer") && length > 0) {
      return { ...base, kind: "vector", length, ...numberRange(items, itemType) };
    }
  }
  return { ...base, kind: "json" };
}

function describeNumber(base: ControlBase, node: JsonObject, type: string): Control {
  const range = numberRange(node, type);
  const { minimum, maximum } = range;
  const bounded = minimum !== undefined && maximum !== undefined && maximum > minimum;
  if (!bounded || (range.integer && maximum - minimum > maxIntegerSliderRange)) {
    return { ...base, kind: "number", ...range };
  }
  const scale = scaleFor(minimum, maximum, base.default);
  return { ...base, kind: "slider", ...range, minimum, maximum, scale };
}

/** Non-linear where typical values are small compared with the maximum. */
function scaleFor(
  minimum: number,
  maximum: number,
  defaultValue: JsonValue | undefined,
): SliderScale {
  if (minimum > 0 && maximum / minimum >= 1000) return "logarithmic";
  const small =
    typeof defaultValue === "number" && defaultValue > 0 && defaultValue < 0.06 * maximum;
  return minimum === 0 && small ? "cubic" : "linear";
}

function numberRange(node: JsonObject, type: string): NumberRange {
  const integer = type === "integer";
  const minimum = numeric(node.minimum) ?? numeric(node.exclusiveMinimum);
  const maximum = numeric(node.maximum) ?? numeric(node.exclusiveMaximum);
  const explicit = numeric(node.multipleOf);
  const span = minimum !== undefined && maximum !== undefined ? maximum - minimum : undefined;
  const step = explicit ?? (integer ? 1 : span ? niceStep(span / 200) : 0.1);
  return { minimum, maximum, step, integer };
}

/** The largest of 1, 2, 5 times a power of ten that is not above the given width. */
export function niceStep(width: number): number {
  const power = 10 ** Math.floor(Math.log10(width));
  const leading = width / power;
  const factor = leading >= 5 ? 5 : leading >= 2 ? 2 : 1;
  return Number((factor * power).toPrecision(6));
}

/** Decimals that distinguish neighbouring values of this step. */
function decimalsOf(step: number): number {
  return Math.min(6, Math.max(0, Math.ceil(-Math.log10(step) - 1e-9)));
}

/** Formats a number with the digits that its control distinguishes, without trailing zeros. */
export function formatNumber(value: number, range: NumberRange): string {
  if (range.integer) return String(Math.round(value));
  const threeDigits = value === 0 ? 0 : 2 - Math.floor(Math.log10(Math.abs(value)));
  const decimals = Math.min(7, Math.max(decimalsOf(range.step), threeDigits));
  return String(Number(value.toFixed(decimals)));
}

/** Parses typed text and clamps it to the range; null if it is not a number. */
export function parseNumber(typed: string, range: NumberRange): number | null {
  const value = Number(typed.trim().replace(",", "."));
  if (typed.trim() === "" || !Number.isFinite(value)) return null;
  const low = range.minimum ?? -Infinity;
  const high = range.maximum ?? Infinity;
  return Math.min(high, Math.max(low, range.integer ? Math.round(value) : value));
}

/** Slider position in [0, 1] of a value. */
export function sliderPosition(control: SliderControl, value: number): number {
  const { minimum, maximum, scale } = control;
  const inside = Math.min(maximum, Math.max(minimum, value));
  if (scale === "logarithmic") return Math.log(inside / minimum) / Math.log(maximum / minimum);
  const fraction = (inside - minimum) / (maximum - minimum);
  return scale === "cubic" ? Math.cbrt(fraction) : fraction;
}

/** Value at a slider position in [0, 1], rounded to the control's step or to three digits. */
export function sliderValue(control: SliderControl, position: number): number {
  const { minimum, maximum, step, scale } = control;
  const span = maximum - minimum;
  let value: number;
  if (scale === "linear") {
    value = Number((minimum + Math.round((position * span) / step) * step).toFixed(6));
  } else {
    const exact =
      scale === "cubic"
        ? minimum + span * position ** 3
        : minimum * (maximum / minimum) ** position;
    value = control.integer ? Math.round(exact) : Number(exact.toPrecision(3));
  }
  return Math.min(maximum, Math.max(minimum, value));
}

function resolve(root: JsonObject, value: JsonValue): JsonObject {
  if (!isObject(value)) return {};
  if (typeof value.$ref !== "string" || !value.$ref.startsWith("#/")) return value;
  let node: JsonValue | undefined = root;
  for (const name of value.$ref.slice(2).split("/")) node = isObject(node) ? node[name] : undefined;
  return isObject(node) ? { ...node, ...value } : value;
}

function typeOf(node: JsonObject): string {
  if (Array.isArray(node.type)) return String(node.type.find((name) => name !== "null") ?? "");
  return text(node.type);
}

function vectorLength(node: JsonObject): number {
  const explicit = numeric(node.maxItems) ?? numeric(node.minItems);
  return explicit ?? (Array.isArray(node.default) ? node.default.length : 0);
}

function numeric(value: JsonValue | undefined): number | undefined {
  return typeof value === "number" ? value : undefined;
}

function text(value: JsonValue | undefined): string {
  return typeof value === "string" ? value : "";
}

function lastName(path: string): string {
  return path.slice(path.lastIndexOf(".") + 1);
}
