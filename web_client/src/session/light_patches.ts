// Lights as lights.add takes them.

import type { LightInfo, LightPatch, LightAdd } from "heliograph/messages.ts";

export type NewLight = LightAdd;

const members: (keyof LightPatch & keyof LightInfo)[] = [
  "enabled",
  "color",
  "temperature",
  "intensity",
  "position",
  "direction",
  "range",
  "radius",
  "angular_diameter",
  "width",
  "height",
  "inner_cone",
  "outer_cone",
];

/** What adds this light again: of one that the file has, the members that differ from it. */
export function addRequest(light: LightInfo): NewLight {
  const differs = (member: string): boolean => light.added || light.changed.includes(member);
  // A temperature gives the colour.
  const patch = members
    .filter((member) => light[member] !== undefined && differs(member))
    .filter((member) => member !== "color" || light.temperature === undefined)
    .map((member) => [member, light[member]]);
  return { type: light.type, name: light.name, patch: Object.fromEntries(patch) as LightPatch };
}
