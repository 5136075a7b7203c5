import assert from "node:assert/strict";
import test from "node:test";
import type { Hello, StreamSettings } from "heliograph/messages.ts";
import { RpcPeer } from "heliograph/rpc.ts";
import { StreamRequests } from "../src/session/stream_requests.ts";

Object.assign(globalThis, { location: new URL("http://a.example/") });

const hello = { codecs: ["h264", "jpeg"] } as Hello;

/** A stream whose far end takes on whatever it is asked for. */
function stream() {
  const asked: Partial<StreamSettings>[] = [];
  const told: string[] = [];
  let settings = {};
  const rpc: RpcPeer = new RpcPeer((text) => {
    const { id, params } = JSON.parse(text) as { id: number; params: Partial<StreamSettings> };
    asked.push(params);
    settings = { ...settings, ...params };
    const answer = JSON.stringify({ jsonrpc: "2.0", id, result: settings });
    queueMicrotask(() => rpc.receive(answer));
  }, () => {});
  rpc.open();
  const requests = new StreamRequests(rpc, {
    mayResize: () => true,
    report: (error) => assert.fail(String(error)),
    tell: (sentence) => told.push(sentence),
  });
  return { asked, told, requests };
}

const settled = () => new Promise((resolve) => setTimeout(resolve, 0));
const pauses = (asked: Partial<StreamSettings>[]) => asked.map(({ paused }) => paused);

test("a video that breaks begins anew by a pause", async () => {
  const { asked, told, requests } = stream();
  await requests.begin(hello, false);
  requests.videoBroke();
  await settled();
  assert.deepEqual(pauses(asked), [undefined, true, false]);
  assert.deepEqual(told, []);
});

test("a video that breaks before anything was asked for begins anew at once", async () => {
  const { asked, requests } = stream();
  requests.videoBroke();
  await requests.begin(hello, false);
  assert.deepEqual(pauses(asked), [true, false]);
  requests.end();
  await requests.begin(hello, false);
  assert.deepEqual(pauses(asked), [true, false, undefined]);
});

test("pictures that are held back stay so, though a video broke early", async () => {
  const { asked, requests } = stream();
  requests.videoBroke();
  await requests.begin(hello, true);
  assert.deepEqual(pauses(asked), [true]);
  await requests.show();
  assert.deepEqual(pauses(asked), [true, false]);
});

test("a video that keeps breaking gives way to single pictures, one that recovers does not", async () => {
  const { asked, told, requests } = stream();
  await requests.begin(hello, false);
  for (let round = 0; round < 6; round += 1) {
    requests.videoBroke();
    for (let picture = 0; picture < 60; picture += 1) requests.videoWorked();
  }
  assert.deepEqual(told, []);
  for (let round = 0; round < 4; round += 1) requests.videoBroke();
  await settled();
  assert.equal(told.length, 1);
  assert.ok(asked.some(({ codec }) => codec === "jpeg"));
});

test("the size that another viewer chose is in effect here, too", async () => {
  const { asked, requests } = stream();
  const sizeNow = () => requests.settings.value;
  requests.sizeTold({ width: 320, height: 180 });
  assert.equal(sizeNow(), null, "nothing is known yet");
  await requests.begin(hello, false);
  const before = asked.length;
  requests.sizeTold({ width: 320, height: 180 });
  assert.deepEqual([sizeNow()?.width, sizeNow()?.height], [320, 180]);
  requests.sizeTold({});
  assert.equal(sizeNow()?.width, 320);
  assert.equal(asked.length, before, "nobody was asked");
});
