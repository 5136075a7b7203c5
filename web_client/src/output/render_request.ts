// The job that renders what a page shows.

import type {
  EditDocument,
  JobCreateParams,
  JobCreateParamsEntries,
  JobCreateParamsEntriesPath,
} from "heliograph/messages.ts";
import { valueAt } from "heliograph/settings_tree.ts";
import { type ViewState, withoutPath } from "../session/view_state.ts";
import type { Path } from "../view/path_player.ts";
import type { ImageSize } from "./size_fields.ts";

export interface RenderWish {
  size: ImageSize;
  /** Similarity to the converged image; null: all samples of the settings. */
  quality: number | null;
  transparent: boolean;
  format: NonNullable<JobCreateParamsEntries["format"]>;
  /** Frames of one turn around the scene; null: one image. */
  turntable: number | null;
  /** A camera that moves; null: one that stays. */
  path: Path | null;
  fps: number;
}

export const videoFormats: ReadonlySet<RenderWish["format"]> = new Set([
  "mp4",
  "webm",
  "animated_webp",
]);

const extensions: Partial<Record<RenderWish["format"], string>> = {
  jpeg: "jpg",
  animated_webp: "webp",
};

const bufferSetting = "view.buffer";

/** What a job cannot know of the view, as one sentence; empty: it knows everything. */
export function leftOut({ part }: ViewState): string {
  return part === undefined ? "" : "Not part of it: the choice of a scene in the file.";
}

function pathOf({ keys, form, seconds }: Path): JobCreateParamsEntriesPath {
  return {
    keys: keys.map(({ eye, target, up, vertical_fov }) => ({ eye, target, up, vertical_fov })),
    seconds,
    easing: form.smooth ? "smooth" : "linear",
    closed: form.closed,
  };
}

/**
 * `edits`: what differs from the scene's file; its environment is that of the view.
 * @throws Error where the view has no scene or camera
 */
export function renderJob(
  state: ViewState,
  stem: string,
  wish: RenderWish,
  edits: EditDocument | null = null,
): JobCreateParams {
  const { scene, camera, variant, environment, clip } = state;
  if (scene === undefined || !camera) throw new Error("There is no scene to render");
  const { eye, target, up, vertical_fov } = camera;
  const buffer = String(valueAt(state.settings ?? {}, bufferSetting) ?? "output");
  const settings = withoutPath(state.settings ?? {}, bufferSetting);
  const moves = wish.turntable !== null || wish.path !== null;
  const numbered = moves && !videoFormats.has(wish.format);
  const extension = extensions[wish.format] ?? wish.format;
  const entry: JobCreateParamsEntries = {
    scene,
    output: `${stem}${numbered ? "_{frame:04}" : ""}.${extension}`,
    format: wish.format,
    ...wish.size,
  };
  if (wish.path) Object.assign(entry, { path: pathOf(wish.path), fps: wish.fps });
  else entry.view = { eye, target, up, vertical_fov };
  if (buffer !== "output") entry.buffer = buffer;
  // Other buffers have neither a similarity nor a background.
  else if (wish.quality !== null) entry.quality = wish.quality;
  if (wish.transparent && buffer === "output") entry.background = "transparent";
  if (Object.keys(settings).length > 0) entry.settings = settings;
  if (edits) entry.edits = { ...edits, environment: undefined };
  if (variant !== undefined) entry.variant = variant;
  if (environment) entry.environment = environment;
  if (clip) Object.assign(entry, { clip: clip.clip, time: clip.seconds });
  if (wish.turntable !== null) Object.assign(entry, { turntable: wish.turntable, fps: wish.fps });
  const what = wish.path ? " path" : wish.turntable === null ? "" : " turntable";
  return { name: `${stem}${what}, ${wish.size.width} x ${wish.size.height}`, entries: [entry] };
}
