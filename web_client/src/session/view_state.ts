// What the page shows, in a form for links, bookmarks and the restore after a reconnect.

import type { JsonObject } from "heliograph/json.ts";
import type { AnimationState, EditDocumentTextures, Section } from "heliograph/messages.ts";
import { type ControlGroup, allControls } from "heliograph/settings_schema.ts";
import { joinPatches, patchOf, sameValue, valueAt } from "heliograph/settings_tree.ts";
import type { CameraPose } from "../common/camera_pose.ts";
import type { Edits } from "./scene_edits.ts";

export interface ClipState {
  clip: string;
  seconds: number;
  rate: number;
  playing: boolean;
}

/** Ids of nodes. */
export interface NodesShown {
  hidden: number[];
  isolated: number[];
  selected: number[];
}

/** Members that are left out keep the server's values. */
export interface ViewState {
  scene?: string;
  /** Which scene of a file that holds several. */
  part?: number;
  variant?: string;
  /** null: the scene's own. */
  environment?: string | null;
  /** Differences from the scene's file. */
  lights?: Edits;
  materials?: Edits;
  textures?: EditDocumentTextures[];
  nodes?: NodesShown;
  /** Planes that cut the scene open. */
  section?: Section;
  /** Differences from the defaults. */
  settings?: JsonObject;
  /** null: the scene is in its rest pose. */
  clip?: ClipState | null;
  camera?: CameraPose;
}

/** The smallest patch that leads from the defaults to `tree`. */
export function changesOf(schema: ControlGroup, tree: JsonObject): JsonObject {
  return allControls(schema).reduce<JsonObject>((patch, control) => {
    const value = valueAt(tree, control.path);
    const changed = value !== undefined && !sameValue(value, control.default);
    return changed ? joinPatches(patch, patchOf(control.path, value)) : patch;
  }, {});
}

/** The patch that leads from `tree` to the defaults with `changes`; null if they are equal. */
export function patchTowards(
  schema: ControlGroup,
  tree: JsonObject,
  changes: JsonObject,
): JsonObject | null {
  let patch: JsonObject | null = null;
  for (const { path, default: defaultValue } of allControls(schema)) {
    const target = valueAt(changes, path) ?? defaultValue;
    const current = valueAt(tree, path);
    if (target === undefined || current === undefined || sameValue(target, current)) continue;
    patch = joinPatches(patch ?? {}, patchOf(path, target));
  }
  return patch;
}

/** Removes a path from a patch, and the groups that become empty. */
export function withoutPath(patch: JsonObject, path: string): JsonObject {
  const [name, ...rest] = path.split(".");
  const { [name as string]: inner, ...others } = patch;
  if (rest.length === 0 || inner === undefined) return others;
  const remaining = withoutPath(inner as JsonObject, rest.join("."));
  return Object.keys(remaining).length > 0 ? { ...others, [name as string]: remaining } : others;
}

/** The clip at the current time; null while no clip is active. */
export function clipState(animation: AnimationState | null, readAt: number): ClipState | null {
  if (!animation?.clip) return null;
  const { clip, rate, playing, lockstep } = animation;
  const elapsed = playing && !lockstep ? ((Date.now() - readAt) / 1000) * rate : 0;
  return { clip, rate, playing, seconds: animation.seconds + elapsed };
}
