// Where no WebSocket gets through, the pictures come as motion JPEG: to be seen, not to be steered.

import { MultipartReader } from "../stream/multipart.ts";
import { type SessionAddress, mainSession } from "../stream/session_address.ts";
import type { Viewer } from "../session/viewer.ts";

const againAfterMs = 2000;
/** The server sends a resting picture again more often than that. */
const longestSilenceMs = 45_000;

export function mountMjpegFallback(viewer: Viewer, image: HTMLImageElement): void {
  const { place, state } = viewer.connection;
  let shown: AbortController | null = null;
  state.watch(({ kind }) => {
    if (kind === "mjpeg_fallback" && !shown) {
      shown = new AbortController();
      void showUntil(shown.signal, place, image);
    } else if (kind === "live" && shown) {
      shown.abort();
      shown = null;
      image.hidden = true;
    }
  });
}

/** Loads the stream anew as often as it ends. */
async function showUntil(ended: AbortSignal, place: SessionAddress, image: HTMLImageElement): Promise<void> {
  let session = place.session ?? mainSession;
  while (!ended.aborted) {
    try {
      const found = await showStream(ended, place.address(addressOf(session)), image);
      if (!found) session = mainSession;
    } catch {
      // Broken, or nobody answered.
    }
    if (ended.aborted) return;
    image.hidden = true;
    await new Promise((resolve) => setTimeout(resolve, againAfterMs));
  }
}

function addressOf(session: string): string {
  return `api/v1/sessions/${encodeURIComponent(session)}/stream.mjpg`;
}

/** Shows pictures as long as they come; false where there is no such session. */
async function showStream(
  ended: AbortSignal,
  address: URL,
  image: HTMLImageElement,
): Promise<boolean> {
  const silence = new AbortController();
  const abort = (): void => silence.abort();
  ended.addEventListener("abort", abort);
  let timer = setTimeout(abort, longestSilenceMs);
  try {
    const response = await fetch(address, { signal: silence.signal });
    const boundary = /boundary=([^;]+)/.exec(response.headers.get("content-type") ?? "")?.[1];
    if (!response.ok || !response.body || !boundary) return response.status !== 404;
    const reader = response.body.getReader();
    const parts = new MultipartReader(boundary);
    for (let read = await reader.read(); !read.done; read = await reader.read()) {
      clearTimeout(timer);
      timer = setTimeout(abort, longestSilenceMs);
      const picture = parts.push(read.value);
      if (picture && !ended.aborted) await show(picture, image);
    }
    return true;
  } finally {
    clearTimeout(timer);
    ended.removeEventListener("abort", abort);
  }
}

/** Waits for the decoder, so that a slow one gets fewer pictures, not later ones. */
async function show(picture: Uint8Array, image: HTMLImageElement): Promise<void> {
  const before = image.src;
  image.src = URL.createObjectURL(new Blob([picture as BlobPart], { type: "image/jpeg" }));
  image.hidden = false;
  await image.decode().catch(() => {}); // the next one may be whole
  if (before) URL.revokeObjectURL(before);
}
