// A capture in another size than that of the view: of a copy of the session that has this size.

import type { FrameStats } from "heliograph/messages.ts";
import type { Viewer } from "../session/viewer.ts";
import { Connection } from "../stream/connection.ts";
import { SessionAddress } from "../stream/session_address.ts";

const createTimeoutMs = 120_000;
const statsIntervalMs = 250;
const smallestQuality = 10;
/** If the page closes during a capture. */
const idleSeconds = 30;

interface SizedCapture {
  width: number;
  height: number;
  buffer: string;
  /** As in the address of a frame. */
  extension: "png" | "jpg" | "exr";
  /** undefined: all that a static view accumulates. */
  samples: number | undefined;
}

interface SizedImage {
  file: Blob;
  samples: number;
}

/**
 * Renders the session's view in the given size. Reports the samples so far.
 * @throws Error with the server's reason, also where it has no room; AbortError
 */
export async function captureInSize(
  viewer: Viewer,
  { width, height, buffer, extension, samples }: SizedCapture,
  signal: AbortSignal,
  progress: (samples: number) => void,
): Promise<SizedImage> {
  const size = { width, height, idle_timeout: idleSeconds };
  const params = { copy_of: viewer.hello?.session ?? "main", ...size };
  const { name } = await viewer.rpc.request("session.create", params, createTimeoutMs);
  const figures = watchSamples(viewer, name, progress);
  try {
    signal.throwIfAborted();
    const url = viewer.connection.address.url(`api/v1/sessions/${name}/frame.${extension}`);
    url.searchParams.set("buffer", buffer);
    return await download(url, samples, signal);
  } finally {
    // If this fails, the session ends by its idle timeout.
    await figures.rpc.request("session.close", { session: name }).catch(() => {});
    figures.dispose();
    viewer.rpc.notify("session.close", { session: name });
  }
}

/**
 * Renders the session's view as a PNG file without background: the server makes a copy itself.
 * @throws Error with the server's reason; AbortError
 */
export async function captureWithoutBackground(
  viewer: Viewer,
  { width, height, samples }: SizedCapture,
  signal: AbortSignal,
): Promise<SizedImage> {
  const session = viewer.hello?.session ?? "main";
  const url = viewer.connection.address.url(`api/v1/sessions/${session}/frame.png`);
  const parameters = { transparent: "1", width: String(width), height: String(height) };
  for (const [name, value] of Object.entries(parameters)) url.searchParams.set(name, value);
  return download(url, samples, signal);
}

async function download(
  url: URL,
  samples: number | undefined,
  signal: AbortSignal,
): Promise<SizedImage> {
  if (samples !== undefined) url.searchParams.set("samples", String(samples));
  const response = await fetch(url, { signal });
  if (!response.ok) throw new Error((await response.text()).trim());
  const rendered = Number(response.headers.get("x-heliograph-samples") ?? samples ?? 1);
  return { file: await response.blob(), samples: rendered };
}

/** A connection to the session for the figures of its frames, which are not shown. */
function watchSamples(
  viewer: Viewer,
  session: string,
  progress: (samples: number) => void,
): Connection {
  const connection = new Connection(
    document.baseURI,
    null,
    {
      live: async () => {
        await connection.rpc.request("stream.configure", { quality: smallestQuality });
        await connection.rpc.request("stats.subscribe", { interval_ms: statsIntervalMs });
      },
      notification: (method, params) => {
        if (method === "stats.frame") progress((params as FrameStats).samples);
      },
      drawn: (frame) => progress(frame.samples),
      draw: (image) => image.close(),
      warning: () => {},
      decodeFailed: () => {},
    },
    new SessionAddress(document.baseURI, viewer.connection.address.route, session),
  );
  connection.open();
  return connection;
}
