// What of a scene's lights and materials differs from its file: patches by name, small enough for
// a link.

import type { JsonObject, JsonValue } from "heliograph/messages.ts";
import { isObject, sameValue } from "heliograph/settings_tree.ts";

/** One patch for each light or material that is not as in the file. */
export type Edits = Record<string, JsonObject>;

/** A light or a material as the server describes it. */
export interface Part {
  name: string;
  changed?: string[];
}

/** More than these do not fit into a link. */
export const mostEdits = 64;
const mostMembers = 16;
const longestName = 256;

/** What leads from the file to these parts; undefined where the server does not tell. */
export function editsOf(parts: readonly Part[]): Edits | undefined {
  if (!parts.some(({ changed }) => changed)) return undefined;
  const edited = parts.filter(({ changed }) => changed && changed.length > 0);
  return Object.fromEntries(
    edited.slice(0, mostEdits).map((part) => [part.name, pick(part, part.changed ?? [])]),
  );
}

/** The patches that lead from parts as they are to the file with `edits`. */
export function patchesTowards(parts: readonly Part[], edits: Edits): Edits {
  const patches: Edits = {};
  for (const part of parts) {
    const wanted = edits[part.name] ?? {};
    const patch: JsonObject = {};
    for (const member of part.changed ?? []) {
      if (!(member in wanted)) patch[member] = null;
    }
    const now = pick(part, Object.keys(wanted));
    for (const [member, value] of Object.entries(wanted)) {
      if (!sameValue(now[member], value)) patch[member] = value;
    }
    if (Object.keys(patch).length > 0) patches[part.name] = patch;
  }
  return patches;
}

/** The patches that lead from the file with `before` to the file with `after`. */
export function editsBetween(before: Edits, after: Edits): Edits {
  const patches: Edits = {};
  for (const name of new Set([...Object.keys(before), ...Object.keys(after)])) {
    const [had, has] = [before[name] ?? {}, after[name] ?? {}];
    const gone = Object.keys(had).filter((member) => !(member in has));
    const other = Object.entries(has).filter(([member, value]) => !sameValue(had[member], value));
    const patch = Object.fromEntries([...gone.map((member) => [member, null]), ...other]);
    if (Object.keys(patch).length > 0) patches[name] = patch as JsonObject;
  }
  return patches;
}

/** The edits in a message from anywhere: what is no such thing is left out. */
export function checkedEdits(value: JsonValue | undefined): Edits | undefined {
  if (!isObject(value)) return undefined;
  const entries = Object.entries(value)
    .filter(([name, patch]) => name.length <= longestName && isPatch(patch))
    .slice(0, mostEdits);
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
  return members.length <= mostMembers && members.every(isPlain);
}

/** A number, a switch or a vector. */
function isPlain(value: JsonValue): boolean {
  if (typeof value === "boolean" || Number.isFinite(value)) return true;
  return Array.isArray(value) && value.length <= 4 && value.every(Number.isFinite);
}
