import assert from "node:assert/strict";
import test from "node:test";
import type { Hello, StreamSettings } from "heliograph/messages.ts";
import { RpcPeer } from "heliograph/rpc.ts";
import { StreamRequests } from "../src/session/stream_requests.ts";

Object.assign(globalThis, { location: new URL("http://a.example/") });

const hello = { codecs: ["h264", "jpeg"] } as Hello;

/** A stream whose server accepts every request. */
function stream() {
  const sent: Partial<StreamSettings>[] = [];
  const informed: string[] = [];
  let settings = {};
  const rpc: RpcPeer = new RpcPeer(
    (text) => {
      const { id, params } = JSON.parse(text) as { id: number; params: Partial<StreamSettings> };
      sent.push(params);
      settings = { ...settings, ...params };
      const answer = JSON.stringify({ jsonrpc: "2.0", id, result: settings });
      queueMicrotask(() => rpc.receive(answer));
    },
    () => {},
  );
  rpc.open();
  const requests = new StreamRequests(rpc, {
    mayResize: () => true,
    report: (error) => assert.fail(String(error)),
    inform: (sentence) => informed.push(sentence),
  });
  return { sent, informed, requests };
}

const settled = () => new Promise((resolve) => setTimeout(resolve, 0));
const pauses = (sent: Partial<StreamSettings>[]) => sent.map(({ paused }) => paused);

test("a video error restarts the stream by a pause", async () => {
  const { sent, informed, requests } = stream();
  await requests.begin(hello, false);
  requests.onVideoError();
  await settled();
  assert.deepEqual(pauses(sent), [undefined, true, false]);
  assert.deepEqual(informed, []);
});

test("a video error before the first request restarts the stream at once", async () => {
  const { sent, requests } = stream();
  requests.onVideoError();
  await requests.begin(hello, false);
  assert.deepEqual(pauses(sent), [true, false]);
  requests.end();
  await requests.begin(hello, false);
  assert.deepEqual(pauses(sent), [true, false, undefined]);
});

test("a stream that starts paused stays paused after an early video error", async () => {
  const { sent, requests } = stream();
  requests.onVideoError();
  await requests.begin(hello, true);
  assert.deepEqual(pauses(sent), [true]);
  await requests.resume();
  assert.deepEqual(pauses(sent), [true, false]);
});

test("repeated video errors switch to JPEG, errors with recovery in between do not", async () => {
  const { sent, informed, requests } = stream();
  await requests.begin(hello, false);
  for (let round = 0; round < 6; round += 1) {
    requests.onVideoError();
    for (let frame = 0; frame < 60; frame += 1) requests.onVideoFrame();
  }
  assert.deepEqual(informed, []);
  for (let round = 0; round < 4; round += 1) requests.onVideoError();
  await settled();
  assert.equal(informed.length, 1);
  assert.ok(sent.some(({ codec }) => codec === "jpeg"));
});

test("the frame size that another viewer chose applies to this page", async () => {
  const { sent, requests } = stream();
  const settings = () => requests.settings.value;
  requests.onFrameSize({ width: 320, height: 180 });
  assert.equal(settings(), null, "unknown before the first settings");
  await requests.begin(hello, false);
  const before = sent.length;
  requests.onFrameSize({ width: 320, height: 180 });
  assert.deepEqual([settings()?.width, settings()?.height], [320, 180]);
  requests.onFrameSize({});
  assert.equal(settings()?.width, 320);
  assert.equal(sent.length, before, "no request was sent");
});
