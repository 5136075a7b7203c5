// Differences between a scene's lights and materials and its file: patches by name, small enough
// for a link.

import type { JsonObject, JsonValue } from "heliograph/json.ts";
import type { LightAdd, LightInfo, LightPatch } from "heliograph/messages.ts";
import { isObject, sameValue } from "heliograph/settings_tree.ts";

/** One patch for each light or material that differs from the file. */
export type Edits = Record<string, JsonObject>;

/** A light or a material as the server describes it. */
export interface Part {
  name: string;
  changed?: string[];
  /** Whether it is none of the file's, which a link cannot bring back. */
  added?: boolean;
}

/** Limits of what fits into a link. */
export const maxEdits = 64;
const maxMembers = 32;
const maxNameLength = 256;

/** The patches that lead from the file to these parts; undefined where the server does not tell. */
export function editsOf(parts: readonly Part[]): Edits | undefined {
  if (!parts.some(({ changed }) => changed)) return undefined;
  const edited = parts.filter(({ changed, added }) => changed && changed.length > 0 && !added);
  return Object.fromEntries(
    edited.slice(0, maxEdits).map((part) => [part.name, pick(part, part.changed ?? [])]),
  );
}

/** The patches that lead from the parts' current state to the file with `edits`. */
export function patchesTowards(parts: readonly Part[], edits: Edits): Edits {
  const patches: Edits = {};
  for (const part of parts.filter(({ added }) => !added)) {
    const target = edits[part.name] ?? {};
    const patch: JsonObject = {};
    for (const member of part.changed ?? []) {
      if (!(member in target)) patch[member] = null;
    }
    const current = pick(part, Object.keys(target));
    for (const [member, value] of Object.entries(target)) {
      if (!sameValue(current[member], value)) patch[member] = value;
    }
    if (Object.keys(patch).length > 0) patches[part.name] = patch;
  }
  return patches;
}

/** The patches that lead from the file with `before` to the file with `after`. */
export function editsBetween(before: Edits, after: Edits): Edits {
  const patches: Edits = {};
  for (const name of new Set([...Object.keys(before), ...Object.keys(after)])) {
    const [old, next] = [before[name] ?? {}, after[name] ?? {}];
    const removed = Object.keys(old).filter((member) => !(member in next));
    const changed = Object.entries(next).filter(
      ([member, value]) => !sameValue(old[member], value),
    );
    const patch = Object.fromEntries([...removed.map((member) => [member, null]), ...changed]);
    if (Object.keys(patch).length > 0) patches[name] = patch as JsonObject;
  }
  return patches;
}

const lightMembers: (keyof LightPatch & keyof LightInfo)[] = [
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
export function addRequest(light: LightInfo): LightAdd {
  const differs = (member: string): boolean => light.added || light.changed.includes(member);
  // A temperature gives the colour.
  const patch = lightMembers
    .filter((member) => light[member] !== undefined && differs(member))
    .filter((member) => member !== "color" || light.temperature === undefined)
    .map((member) => [member, light[member]]);
  return { type: light.type, name: light.name, patch: Object.fromEntries(patch) as LightPatch };
}

/** The valid edits of an untrusted value. */
export function checkedEdits(value: JsonValue | undefined): Edits | undefined {
  if (!isObject(value)) return undefined;
  const entries = Object.entries(value)
    .filter(([name, patch]) => name.length <= maxNameLength && isPatch(patch))
    .slice(0, maxEdits);
  return Object.fromEntries(entries) as Edits;
}

function pick(part: Part, members: string[]): JsonObject {
  const all = part as unknown as JsonObject;
  return Object.fromEntries(
    members.flatMap((name) => (all[name] === undefined ? [] : [[name, all[name]]])),
  );
}

function isPatch(value: JsonValue): boolean {
  if (!isObject(value)) return false;
  const members = Object.values(value);
  return members.length <= maxMembers && members.every(isPlain);
}

/** A finite number, a boolean or a vector. */
function isPlain(value: JsonValue): boolean {
  if (typeof value === "boolean" || Number.isFinite(value)) return true;
  return Array.isArray(value) && value.length <= 4 && value.every(Number.isFinite);
}
