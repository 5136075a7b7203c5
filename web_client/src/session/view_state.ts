// What a person sees, in a form that survives: a lost connection, a link, a bookmark.

import type { AnimationState, Camera, JsonObject } from "heliograph/messages.ts";
import { type ControlGroup, allControls } from "heliograph/settings_schema.ts";
import { joinPatches, patchOf, sameValue, valueAt } from "heliograph/settings_tree.ts";
import type { Edits } from "./scene_edits.ts";

export interface ClipState {
  clip: string;
  seconds: number;
  rate: number;
  playing: boolean;
}

/** Parts that are left out stay as the server has them. */
export interface ViewState {
  scene?: string;
  /** Which scene of a file that holds several. */
  part?: number;
  variant?: string;
  /** null: the one that goes with the scene. */
  environment?: string | null;
  /** What differs from the scene's file; all else is as there. */
  lights?: Edits;
  materials?: Edits;
  /** Only what differs from the defaults; everything else means the default. */
  settings?: JsonObject;
  /** null: the scene rests in the pose of its file. */
  clip?: ClipState | null;
  camera?: Camera;
}

/** What `tree` changes of the defaults, as the smallest patch. */
export function changesOf(schema: ControlGroup, tree: JsonObject): JsonObject {
  return allControls(schema).reduce<JsonObject>((patch, control) => {
    const value = valueAt(tree, control.path);
    const changed = value !== undefined && !sameValue(value, control.default);
    return changed ? joinPatches(patch, patchOf(control.path, value)) : patch;
  }, {});
}

/** The patch that leads from `tree` to the defaults with `changes`; null where nothing differs. */
export function patchTowards(
  schema: ControlGroup,
  tree: JsonObject,
  changes: JsonObject,
): JsonObject | null {
  let patch: JsonObject | null = null;
  for (const { path, default: standard } of allControls(schema)) {
    const wanted = valueAt(changes, path) ?? standard;
    const there = valueAt(tree, path);
    if (wanted === undefined || there === undefined || sameValue(wanted, there)) continue;
    patch = joinPatches(patch ?? {}, patchOf(path, wanted));
  }
  return patch;
}

/** Leaves a path out of a patch, with the groups that it leaves empty. */
export function withoutPath(patch: JsonObject, path: string): JsonObject {
  const [name, ...rest] = path.split(".");
  const { [name as string]: inner, ...others } = patch;
  if (rest.length === 0 || inner === undefined) return others;
  const kept = withoutPath(inner as JsonObject, rest.join("."));
  return Object.keys(kept).length > 0 ? { ...others, [name as string]: kept } : others;
}

/** The clip as it stands now, or null when none poses the scene. */
export function clipState(animation: AnimationState | null, readAt: number): ClipState | null {
  if (!animation?.clip) return null;
  const { clip, rate, playing, lockstep } = animation;
  const passed = playing && !lockstep ? ((Date.now() - readAt) / 1000) * rate : 0;
  return { clip, rate, playing, seconds: animation.seconds + passed };
}
