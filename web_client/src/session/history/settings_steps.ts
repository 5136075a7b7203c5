// Changes of settings as steps of the history.

import type { JsonObject, JsonValue } from "heliograph/json.ts";
import { type ControlGroup, allControls } from "heliograph/settings_schema.ts";
import { isObject } from "heliograph/settings_tree.ts";

/** The values that a patch will replace: applied later, they undo it. */
export function inverseOf(patch: JsonObject, tree: JsonObject): JsonObject {
  const inverse: JsonObject = {};
  for (const [name, value] of Object.entries(patch)) {
    const before = tree[name];
    if (isObject(value) && isObject(before)) inverse[name] = inverseOf(value, before);
    else if (before !== undefined) inverse[name] = before;
  }
  return inverse;
}

/** The dotted paths of a patch. */
export function pathsOf(patch: JsonValue, prefix = ""): string[] {
  if (!isObject(patch)) return [prefix];
  return Object.entries(patch).flatMap(([name, value]) =>
    pathsOf(value, prefix ? `${prefix}.${name}` : name),
  );
}

/** What a patch changes: one setting, settings of one group, or several. */
export function describePatch(schema: ControlGroup, patch: JsonObject): string {
  const paths = pathsOf(patch);
  const labels = allControls(schema)
    .filter(({ path }) =>
      paths.some((changed) => path === changed || path.startsWith(`${changed}.`)),
    )
    .map(({ label }) => label);
  const groups = Object.keys(patch).map(
    (name) => schema.groups.find(({ path }) => path === name)?.title ?? name,
  );
  const [label, group] = [labels[0] ?? "", groups[0] ?? ""];
  if (groups.length > 1) return `${paths.length} settings`;
  if (labels.length !== 1) return lowered(group);
  return label.startsWith(group) ? lowered(label) : `${lowered(group)}: ${lowered(label)}`;
}

/** "Max history" -> "max history", but "TAA" stays. */
function lowered(label: string): string {
  const second = label.charAt(1);
  return second === second.toLowerCase() ? label.charAt(0).toLowerCase() + label.slice(1) : label;
}
