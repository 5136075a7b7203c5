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
  wanted: Wanted;
  /** Whether measurements and annotations are drawn over it. */
  marks: boolean;
}

/**
 * The samples of an image: so many; all of the hybrid; or those of a view that nothing refines any
 * more, which are the path traced reference's where that follows.
 */
export type Wanted = number | "hybrid" | "final";

/** As captures count: undefined is all of the hybrid, or what a finished view has. */
export const leastSamples = (wanted: Wanted): number | undefined =>
  typeof wanted === "number" ? wanted : undefined;

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
  { width, height, buffer, extension, wanted, marks }: SizedCapture,
  signal: AbortSignal,
  progress: (samples: number) => void,
): Promise<SizedImage> {
  const size = { width, height, idle_timeout: idleSeconds };
  const params = { copy_of: viewer.membership.name, ...size };
  const { name } = await viewer.rpc.request("session.create", params, createTimeoutMs);
  const copy = watchSamples(viewer, name, progress);
  try {
    signal.throwIfAborted();
    if (wanted === "final") await Promise.race([copy.final, aborted(signal)]);
    const url = viewer.connection.address.url(`api/v1/sessions/${name}/frame.${extension}`);
    url.searchParams.set("buffer", buffer);
    if (marks) url.searchParams.set("marks", "1");
    return await download(url, wanted, signal);
  } finally {
    // If this fails, the session ends by its idle timeout.
    await copy.connection.rpc.request("session.close", { session: name }).catch(() => {});
    copy.connection.dispose();
    viewer.rpc.notify("session.close", { session: name });
  }
}

/**
 * Renders the session's view as a PNG file without background: the server makes a copy itself.
 * @throws Error with the server's reason; AbortError
 */
export async function captureWithoutBackground(
  viewer: Viewer,
  { width, height, wanted, marks }: SizedCapture,
  signal: AbortSignal,
): Promise<SizedImage> {
  const session = viewer.membership.name;
  const url = viewer.connection.address.url(`api/v1/sessions/${session}/frame.png`);
  const parameters = { transparent: "1", width: String(width), height: String(height) };
  for (const [name, value] of Object.entries(parameters)) url.searchParams.set(name, value);
  if (marks) url.searchParams.set("marks", "1");
  return download(url, wanted, signal);
}

async function download(
  url: URL,
  wanted: Wanted,
  signal: AbortSignal,
): Promise<SizedImage> {
  const samples = leastSamples(wanted);
  if (samples !== undefined) url.searchParams.set("samples", String(samples));
  const response = await fetch(url, { signal });
  if (!response.ok) throw new Error((await response.text()).trim());
  const rendered = Number(response.headers.get("x-heliograph-samples") ?? samples ?? 1);
  return { file: await response.blob(), samples: rendered };
}

function aborted(signal: AbortSignal): Promise<never> {
  return new Promise((_, reject) => {
    signal.addEventListener("abort", () => reject(signal.reason));
  });
}

/** A connection to the session for the figures of its frames, which are not shown. */
function watchSamples(
  viewer: Viewer,
  session: string,
  progress: (samples: number) => void,
): { connection: Connection; final: Promise<void> } {
  let finish = (): void => {};
  const final = new Promise<void>((resolve) => (finish = resolve));
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
      drawn: (frame) => {
        progress(frame.samples);
        if (frame.final) finish();
      },
      draw: (image) => image.close(),
      warning: () => {},
      decodeFailed: () => {},
    },
    new SessionAddress(document.baseURI, viewer.connection.address.route, session),
  );
  connection.open();
  return { connection, final };
}
