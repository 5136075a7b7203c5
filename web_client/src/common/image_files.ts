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

/** Downloads a file. */
export function saveFile(content: Blob, name: string): void {
  const url = URL.createObjectURL(content);
  const link = document.createElement("a");
  link.href = url;
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(url), 10_000);
}
