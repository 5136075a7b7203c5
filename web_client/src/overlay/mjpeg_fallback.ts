// Where WebSockets do not get through, frames come as motion JPEG, without any control.

import type { Viewer } from "../session/viewer.ts";
import { MultipartReader } from "../stream/multipart.ts";
import { type SessionAddress, mainSession } from "../stream/session_address.ts";

const retryMs = 2000;
/** The server repeats a converged frame more often than this. */
const silenceTimeoutMs = 45_000;

export function mountMjpegFallback(viewer: Viewer, image: HTMLImageElement): void {
  const { address, state } = viewer.connection;
  let shown: AbortController | null = null;
  state.watch(({ kind }) => {
    if (kind === "mjpeg_fallback" && !shown) {
      shown = new AbortController();
      void showUntil(shown.signal, address, image);
    } else if (kind === "live" && shown) {
      shown.abort();
      shown = null;
      image.hidden = true;
    }
  });
}

/** Reloads the stream whenever it ends. */
async function showUntil(
  ended: AbortSignal,
  address: SessionAddress,
  image: HTMLImageElement,
): Promise<void> {
  let session = address.session ?? mainSession;
  while (!ended.aborted) {
    try {
      const found = await showStream(ended, address.url(streamPath(session)), image);
      if (!found) session = mainSession;
    } catch {
      // The stream broke, or the server does not answer.
    }
    if (ended.aborted) return;
    image.hidden = true;
    await new Promise((resolve) => setTimeout(resolve, retryMs));
  }
}

function streamPath(session: string): string {
  return `api/v1/sessions/${encodeURIComponent(session)}/stream.mjpg`;
}

/** Shows frames until the stream ends; false if the session does not exist. */
async function showStream(ended: AbortSignal, url: URL, image: HTMLImageElement): Promise<boolean> {
  const silence = new AbortController();
  const abort = (): void => silence.abort();
  ended.addEventListener("abort", abort);
  let timer = setTimeout(abort, silenceTimeoutMs);
  try {
    const response = await fetch(url, { signal: silence.signal });
    const boundary = /boundary=([^;]+)/.exec(response.headers.get("content-type") ?? "")?.[1];
    if (!response.ok || !response.body || !boundary) return response.status !== 404;
    const reader = response.body.getReader();
    const parts = new MultipartReader(boundary);
    for (let read = await reader.read(); !read.done; read = await reader.read()) {
      clearTimeout(timer);
      timer = setTimeout(abort, silenceTimeoutMs);
      const jpeg = parts.push(read.value);
      if (jpeg && !ended.aborted) await show(jpeg, image);
    }
    return true;
  } finally {
    clearTimeout(timer);
    ended.removeEventListener("abort", abort);
  }
}

/** Waits for the decoder, so that a slow one gets fewer frames, not later ones. */
async function show(jpeg: Uint8Array, image: HTMLImageElement): Promise<void> {
  const before = image.src;
  image.src = URL.createObjectURL(new Blob([jpeg as BlobPart], { type: "image/jpeg" }));
  image.hidden = false;
  await image.decode().catch(() => {}); // the next one may be valid
  if (before) URL.revokeObjectURL(before);
}
