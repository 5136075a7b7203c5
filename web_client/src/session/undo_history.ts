// Undo and redo of settings. All changes of one drag are one step.

import type { JsonObject, JsonValue } from "heliograph/json.ts";
import { isObject, joinPatches } from "heliograph/settings_tree.ts";

interface Step {
  undo: JsonObject;
  redo: JsonObject;
  /** The settings that it changes; only steps with the same ones are merged. */
  paths: string;
  at: number;
}

const mergeWithinMs = 900;
const maxSteps = 200;

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

  /** Adds a change; `undo` leads back to the values before it. */
  add(redo: JsonObject, undo: JsonObject): void {
    const at = this.clock();
    const paths = leafPaths(redo).sort().join();
    const last = this.done[this.done.length - 1];
    this.undone = [];
    if (last && last.paths === paths && at - last.at < mergeWithinMs) {
      last.redo = joinPatches(last.redo, redo);
      last.at = at;
      return;
    }
    this.done.push({ redo, undo, paths, at });
    if (this.done.length > maxSteps) this.done.shift();
  }

  /** The patch that undoes the last step, or null. */
  undo(): JsonObject | null {
    const step = this.done.pop();
    if (!step) return null;
    this.undone.push(step);
    return step.undo;
  }

  redo(): JsonObject | null {
    const step = this.undone.pop();
    if (!step) return null;
    this.done.push({ ...step, at: -Infinity });
    return step.redo;
  }

  clear(): void {
    this.done = [];
    this.undone = [];
  }
}
