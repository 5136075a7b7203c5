// The numbers of a light, a slider for each that its type has.

import type { LightInfo, LightPatch } from "heliograph/messages.ts";
import { createSliderRow } from "../../widgets/slider_row.ts";

type Member =
  | "intensity"
  | "temperature"
  | "angular_diameter"
  | "radius"
  | "width"
  | "height"
  | "range"
  | "inner_cone"
  | "outer_cone";

const sliders: ({ member: Member } & Parameters<typeof createSliderRow>[0])[] = [
  {
    member: "intensity",
    label: "Intensity",
    description:
      "In lux for directional lights, in candela for point and spot lights, as radiance for areas.",
    unit: "",
    minimum: 0.001,
    maximum: 200_000,
    scale: "logarithmic",
  },
  {
    member: "temperature",
    label: "Temperature",
    description: "Gives the light the colour of a black body: 2700 K is warm, 6500 K daylight.",
    unit: "kelvin",
    minimum: 1700,
    maximum: 15_000,
    scale: "logarithmic",
  },
  {
    member: "angular_diameter",
    label: "Angular diameter",
    description: "Apparent size of the light: larger lights cast softer shadows.",
    unit: "degrees",
    minimum: 0,
    maximum: 20,
    scale: "cubic",
  },
  {
    member: "radius",
    label: "Radius",
    description: "Size of the light: larger lights cast softer shadows.",
    unit: "metres",
    minimum: 0,
    maximum: 2,
    scale: "cubic",
  },
  {
    member: "width",
    label: "Width",
    description: "Width of the shining rectangle.",
    unit: "metres",
    minimum: 0.01,
    maximum: 20,
    scale: "logarithmic",
  },
  {
    member: "height",
    label: "Height",
    description: "Height of the shining rectangle.",
    unit: "metres",
    minimum: 0.01,
    maximum: 20,
    scale: "logarithmic",
  },
  {
    member: "range",
    label: "Range",
    description: "Distance at which the light ends; 0: never.",
    unit: "metres",
    minimum: 0,
    maximum: 100,
    scale: "cubic",
  },
  {
    member: "inner_cone",
    label: "Inner cone",
    description: "Angle from the axis at which the light begins to fade; below the outer cone.",
    unit: "degrees",
    minimum: 0,
    maximum: 89,
    scale: "linear",
  },
  {
    member: "outer_cone",
    label: "Outer cone",
    description: "Angle from the axis at which the light ends; above the inner cone.",
    unit: "degrees",
    minimum: 0.1,
    maximum: 90,
    scale: "linear",
  },
];

/** What a temperature slider shows for a light of another colour. */
const daylight = 6500;
/** Between the cones, degrees. */
const leastFade = 0.1;

interface LightRows {
  nodes: HTMLElement[];
  show(light: LightInfo): void;
}

export function createLightRows(
  selected: () => LightInfo | undefined,
  patch: (change: LightPatch) => void,
): LightRows {
  const rows = sliders.map(({ member, ...parts }) => ({
    member,
    row: createSliderRow(parts, (value) => patch(changeOf(member, value, selected()))),
  }));
  const show = (light: LightInfo): void => {
    for (const { member, row } of rows) {
      const value = member === "temperature" ? (light.temperature ?? daylight) : light[member];
      row.node.hidden = value === undefined;
      row.show(value ?? 0);
    }
  };
  return { nodes: rows.map(({ row }) => row.node), show };
}

function changeOf(member: Member, value: number, light: LightInfo | undefined): LightPatch {
  // The colour belongs to the change, so that undoing it brings the colour back.
  if (member === "temperature" && light) return { temperature: value, color: light.color };
  if (member === "inner_cone" && light?.outer_cone !== undefined) {
    return { inner_cone: Math.min(value, light.outer_cone - leastFade) };
  }
  if (member === "outer_cone" && light?.inner_cone !== undefined) {
    return { outer_cone: Math.max(value, light.inner_cone + leastFade) };
  }
  return { [member]: value };
}
