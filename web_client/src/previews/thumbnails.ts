// Thumbnails of scenes, kept in this browser so that they are there at once on the next visit.

import { preferences } from "../common/preferences.ts";
import { Signal } from "../common/signal.ts";

const keyOf = (scene: string): string => `thumbnail.${scene}`;

/** The scene whose thumbnail has changed last. */
export const thumbnailChanged = new Signal("");

export function thumbnailOf(scene: string): string | null {
  return preferences.text(keyOf(scene), "") || null;
}

/** The scene's file is another, or gone. */
export function forgetThumbnail(scene: string): void {
  if (thumbnailOf(scene) === null) return;
  preferences.remove(keyOf(scene));
  thumbnailChanged.set(scene);
}

export function storeThumbnail(scene: string, dataUrl: string): void {
  if (thumbnailOf(scene) === dataUrl) return;
  preferences.setText(keyOf(scene), dataUrl);
  thumbnailChanged.set(scene);
}
