// Steps of changed settings, to go back and forth through. What a drag changes on its way is one
// step.

import type { JsonObject, JsonValue } from "heliograph/messages.ts";
import { isObject, joinPatches } from "heliograph/settings_tree.ts";

interface Step {
  back: JsonObject;
  forth: JsonObject;
  /** Which settings it changes; only steps of the same ones are joined. */
  paths: string;
  at: number;
}

const joinWithinMs = 900;
const longest = 200;

/** The part of the tree that a patch is about to change: applied later, it undoes the patch. */
export function inverseOf(patch: JsonObject, tree: JsonObject): JsonObject {
  const inverse: JsonObject = {};
  for (const [name, value] of Object.entries(patch)) {
    const before = tree[name];
    if (isObject(value) && isObject(before)) inverse[name] = inverseOf(value, before);
    else if (before !== undefined) inverse[name] = before;
  }
  return inverse;
}

function leafPaths(patch: JsonValue, prefix = ""): string[] {
  if (!isObject(patch)) return [prefix];
  return Object.entries(patch).flatMap(([name, value]) => leafPaths(value, `${prefix}.${name}`));
}

export class UndoHistory {
  private done: Step[] = [];
  private undone: Step[] = [];
  private readonly clock: () => number;

  constructor(clock: () => number = () => performance.now()) {
    this.clock = clock;
  }

  get canUndo(): boolean {
    return this.done.length > 0;
  }

  get canRedo(): boolean {
    return this.undone.length > 0;
  }

  /** Takes a change that is being made; `back` leads to what was before. */
  add(forth: JsonObject, back: JsonObject): void {
    const at = this.clock();
    const paths = leafPaths(forth).sort().join();
    const last = this.done[this.done.length - 1];
    this.undone = [];
    if (last && last.paths === paths && at - last.at < joinWithinMs) {
      last.forth = joinPatches(last.forth, forth);
      last.at = at;
      return;
    }
    this.done.push({ forth, back, paths, at });
    if (this.done.length > longest) this.done.shift();
  }

  /** The patch that takes the last step back, or null. */
  undo(): JsonObject | null {
    const step = this.done.pop();
    if (!step) return null;
    this.undone.push(step);
    return step.back;
  }

  redo(): JsonObject | null {
    const step = this.undone.pop();
    if (!step) return null;
    this.done.push({ ...step, at: -Infinity });
    return step.forth;
  }

  clear(): void {
    this.done = [];
    this.undone = [];
  }
}
