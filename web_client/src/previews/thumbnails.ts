// Small pictures of scenes as this browser has seen them, kept between visits.

import { preferences } from "../common/preferences.ts";
import { Signal } from "../common/signal.ts";
import { bufferSetting, type Viewer } from "../session/viewer.ts";

const width = 240;
const restMs = 2500;

const keyOf = (scene: string): string => `thumbnail.${scene}`;

/** Tells that a thumbnail was renewed. */
export const thumbnailChanged = new Signal("");

export function thumbnailOf(scene: string): string | null {
  return preferences.text(keyOf(scene), "") || null;
}

export function keepThumbnail(scene: string, picture: string): void {
  preferences.setText(keyOf(scene), picture);
  thumbnailChanged.set(scene);
}

/** Takes a thumbnail whenever a view of the finished picture has come to rest. */
export function mountThumbnails(viewer: Viewer): void {
  let timer = 0;
  viewer.frame.watch((frame) => {
    clearTimeout(timer);
    if (frame) timer = window.setTimeout(() => void take(viewer), restMs);
  });
}

async function take(viewer: Viewer): Promise<void> {
  const scene = viewer.scene.value?.name;
  const buffer = viewer.settings.value(bufferSetting) ?? "output";
  if (!scene || viewer.loading.value || viewer.restoring.value || buffer !== "output") return;
  const picture = await viewer.connection.copyFrame();
  if (!picture) return;
  const canvas = document.createElement("canvas");
  canvas.width = width;
  canvas.height = Math.round((width * 9) / 16);
  const context = canvas.getContext("2d");
  // The middle of the picture, whatever its shape.
  const fits = Math.min(picture.width / canvas.width, picture.height / canvas.height);
  const [wide, high] = [canvas.width * fits, canvas.height * fits];
  const [left, top] = [(picture.width - wide) / 2, (picture.height - high) / 2];
  if (context) {
    context.imageSmoothingQuality = "high";
    context.drawImage(picture, left, top, wide, high, 0, 0, canvas.width, canvas.height);
    keepThumbnail(scene, canvas.toDataURL("image/jpeg", 0.75));
  }
  picture.close();
}
