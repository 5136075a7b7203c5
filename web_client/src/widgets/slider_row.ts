// A slider like those of the settings, for a number that is not a setting.

import { type NumberRange, type SliderControl } from "heliograph/settings_schema.ts";
import { createRow } from "./setting_row.ts";

interface SliderRow {
  node: HTMLElement;
  show(value: number): void;
}

interface SliderParts {
  label: string;
  description: string;
  unit: string;
  minimum: number;
  maximum: number;
  scale: SliderControl["scale"];
}

export function createSliderRow(parts: SliderParts, report: (value: number) => void): SliderRow {
  const range: NumberRange = {
    minimum: parts.minimum,
    maximum: parts.maximum,
    step: (parts.maximum - parts.minimum) / 200,
    integer: false,
  };
  const control: SliderControl = {
    kind: "slider",
    path: "",
    default: undefined,
    order: 0,
    ...range,
    ...parts,
  };
  const row = createRow(
    control,
    (value) => report(Number(value)),
    () => {},
  );
  return { node: row.node, show: (value) => row.show(value, false) };
}
