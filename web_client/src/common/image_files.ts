// Captures as files, and thumbnails of them.

import type { Capture } from "heliograph/messages.ts";

const mimeTypes: Record<string, string> = {
  png: "image/png",
  jpeg: "image/jpeg",
  exr: "image/x-exr",
  npy: "application/octet-stream",
};

export function captureBlob({ data, format }: Capture): Blob {
  const bytes = Uint8Array.from(atob(data), (letter) => letter.charCodeAt(0));
  return new Blob([bytes], { type: mimeTypes[format] ?? "application/octet-stream" });
}

/** A smaller image of the given width and the same aspect ratio, as a data URL. */
export async function thumbnailUrl(image: Blob, width: number): Promise<string> {
  const whole = await createImageBitmap(image);
  const canvas = document.createElement("canvas");
  canvas.width = width;
  canvas.height = Math.max(1, Math.round((width * whole.height) / whole.width));
  const context = canvas.getContext("2d");
  if (context) {
    context.imageSmoothingQuality = "high";
    context.drawImage(whole, 0, 0, canvas.width, canvas.height);
  }
  whole.close();
  return canvas.toDataURL("image/jpeg", 0.8);
}

/** Downloads a file. */
export function saveFile(content: Blob, name: string): void {
  const url = URL.createObjectURL(content);
  const link = document.createElement("a");
  link.href = url;
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(url), 10_000);
}
