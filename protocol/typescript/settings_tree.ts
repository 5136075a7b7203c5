// Values and patches of the settings tree, addressed by dotted paths.

import type { JsonObject, JsonValue } from "./json.ts";

export function isObject(value: unknown): value is JsonObject {
  return typeof value === "object" && value !== null && !Array.isArray(value);
}

export function valueAt(tree: JsonObject, path: string): JsonValue | undefined {
  let node: JsonValue | undefined = tree;
  for (const name of path.split(".")) {
    if (!isObject(node)) return undefined;
    node = node[name];
  }
  return node;
}

/** The smallest patch that sets one path. */
export function patchOf(path: string, value: JsonValue): JsonObject {
  const names = path.split(".");
  return names.reduceRight<JsonValue>((inner, name) => ({ [name]: inner }), value) as JsonObject;
}

/** Merges two patches; the later one wins. Nulls are kept: they mean "reset". */
export function joinPatches(earlier: JsonObject, later: JsonObject): JsonObject {
  const joined: JsonObject = { ...earlier };
  for (const [name, value] of Object.entries(later)) {
    const before = joined[name];
    joined[name] = isObject(before) && isObject(value) ? joinPatches(before, value) : value;
  }
  return joined;
}

/** RFC 7386 merge, where null restores the default instead of deleting. */
export function mergePatch(
  tree: JsonObject,
  patch: JsonObject,
  defaults: JsonObject | undefined,
): JsonObject {
  const merged: JsonObject = { ...tree };
  for (const [name, value] of Object.entries(patch)) {
    const defaultValue = defaults?.[name];
    if (value === null) {
      if (defaultValue === undefined) delete merged[name];
      else merged[name] = defaultValue;
    } else if (isObject(value)) {
      const before = merged[name];
      merged[name] = mergePatch(
        isObject(before) ? before : {},
        value,
        isObject(defaultValue) ? defaultValue : undefined,
      );
    } else {
      merged[name] = value;
    }
  }
  return merged;
}

export function sameValue(a: JsonValue | undefined, b: JsonValue | undefined): boolean {
  if (typeof a === "number" && typeof b === "number") {
    // The server stores single precision: 0.1 becomes 0.10000000149.
    return a === b || Math.abs(a - b) <= 1e-6 * Math.max(Math.abs(a), Math.abs(b));
  }
  if (Array.isArray(a) && Array.isArray(b)) {
    return a.length === b.length && a.every((entry, index) => sameValue(entry, b[index]));
  }
  if (isObject(a) && isObject(b)) {
    const names = Object.keys(a);
    return (
      names.length === Object.keys(b).length && names.every((name) => sameValue(a[name], b[name]))
    );
  }
  return a === b;
}
