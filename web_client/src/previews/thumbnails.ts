// Thumbnails of scenes, stored in this browser.

import { preferences } from "../common/preferences.ts";
import { Signal } from "../common/signal.ts";
import { bufferSetting, type Viewer } from "../session/viewer.ts";

const width = 240;
const idleMs = 2500;

const keyOf = (scene: string): string => `thumbnail.${scene}`;

/** The scene whose thumbnail has changed last. */
export const thumbnailChanged = new Signal("");

export function thumbnailOf(scene: string): string | null {
  return preferences.text(keyOf(scene), "") || null;
}

export function storeThumbnail(scene: string, dataUrl: string): void {
  preferences.setText(keyOf(scene), dataUrl);
  thumbnailChanged.set(scene);
}

/** Stores a thumbnail whenever no new frame has come for a while. */
export function mountThumbnails(viewer: Viewer): void {
  let timer = 0;
  viewer.frame.watch((frame) => {
    clearTimeout(timer);
    if (frame) timer = window.setTimeout(() => void captureThumbnail(viewer), idleMs);
  });
}

async function captureThumbnail(viewer: Viewer): Promise<void> {
  const scene = viewer.scene.value?.name;
  const buffer = viewer.settings.value(bufferSetting) ?? "output";
  if (!scene || viewer.loading.current.value || viewer.restoring.value || buffer !== "output") return;
  const frame = await viewer.connection.copyFrame();
  if (!frame) return;
  const image = cropped(frame, width);
  if (image) storeThumbnail(scene, image);
  frame.close();
}

/** The frame as a small image of 16:9 around its centre, in a data URL. */
export function cropped(frame: ImageBitmap, width: number): string | null {
  const canvas = document.createElement("canvas");
  canvas.width = width;
  canvas.height = Math.round((width * 9) / 16);
  const context = canvas.getContext("2d");
  if (!context) return null;
  const scale = Math.min(frame.width / canvas.width, frame.height / canvas.height);
  const [wide, high] = [canvas.width * scale, canvas.height * scale];
  const [left, top] = [(frame.width - wide) / 2, (frame.height - high) / 2];
  context.imageSmoothingQuality = "high";
  context.drawImage(frame, left, top, wide, high, 0, 0, canvas.width, canvas.height);
  return canvas.toDataURL("image/jpeg", 0.75);
}
