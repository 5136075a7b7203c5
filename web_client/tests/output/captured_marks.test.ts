import assert from "node:assert/strict";
import test, { afterEach } from "node:test";
import type { FrameCaptureParams } from "heliograph/messages.ts";
import { captureWithoutBackground } from "../../src/output/sized_capture.ts";
import { FrameQueries } from "../../src/session/frame_queries.ts";
import type { Viewer } from "../../src/session/viewer.ts";

const { fetch } = globalThis;
afterEach(() => {
  globalThis.fetch = fetch;
});

test("a capture asks for marks only where they are wanted", async () => {
  const asked: FrameCaptureParams[] = [];
  const request = (_method: string, params: FrameCaptureParams): Promise<unknown> => {
    asked.push(params);
    return Promise.resolve({});
  };
  const host = { rpc: { request }, buffer: () => "output" };
  const queries = new FrameQueries(host as unknown as ConstructorParameters<typeof FrameQueries>[0]);
  await queries.capture();
  await queries.capture(undefined, "jpeg", 4, true);
  assert.deepEqual(asked, [
    { buffer: "output", format: "png" },
    { buffer: "output", format: "jpeg", samples: 4, marks: true },
  ]);
});

test("so does an image without background", async () => {
  const addresses: string[] = [];
  globalThis.fetch = (url) => {
    addresses.push(String(url));
    return Promise.resolve(new Response(new Uint8Array([1])));
  };
  const address = { url: (path: string) => new URL(path, "http://127.0.0.1/") };
  const viewer = { membership: { name: "main" }, connection: { address } } as unknown as Viewer;
  const size = { width: 64, height: 48, buffer: "output", extension: "png", wanted: 2 } as const;
  const { signal } = new AbortController();
  for (const marks of [false, true]) {
    await captureWithoutBackground(viewer, { ...size, marks }, signal);
  }
  const queries = addresses.map((text) => new URL(text).searchParams.get("marks"));
  assert.deepEqual(queries, [null, "1"]);
});
