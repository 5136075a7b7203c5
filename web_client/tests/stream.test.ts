import assert from "node:assert/strict";
import test from "node:test";
import { Backoff } from "../src/stream/backoff.ts";
import { FramePipeline } from "../src/stream/frame_pipeline.ts";
import { LatencyMeter } from "../src/stream/latency.ts";
import { RateMeter } from "../src/stream/rates.ts";

test("back-off doubles up to its maximum and restarts after a reset", () => {
  const longest = new Backoff(400, 10_000, () => 1);
  const waits = Array.from({ length: 7 }, () => longest.next());
  assert.deepEqual(waits, [400, 800, 1600, 3200, 6400, 10_000, 10_000]);
  longest.reset();
  assert.equal(longest.next(), 400);
});

test("jitter spreads viewers over the second half of each delay", () => {
  assert.equal(new Backoff(400, 10_000, () => 0).next(), 200);
  assert.equal(new Backoff(400, 10_000, () => 0.5).next(), 300);
});

test("latency is measured by the first frame of an input, not by refining frames", () => {
  const meter = new LatencyMeter();
  assert.equal(meter.median, null);
  meter.inputSent(1, 100);
  meter.inputSent(2, 110);
  assert.equal(meter.frameDrawn(0, 115), null);
  assert.equal(meter.frameDrawn(2, 150), 40);
  assert.equal(meter.frameDrawn(2, 900), null);
  assert.equal(meter.median, 40);
});

test("the displayed latency is the median of recent measurements", () => {
  const meter = new LatencyMeter(3);
  [500, 20, 30, 900, 40].forEach((delay, index) => {
    meter.inputSent(index + 1, 0);
    meter.frameDrawn(index + 1, delay);
  });
  assert.equal(meter.median, 40);
});

test("a new connection discards pending inputs but keeps the median", () => {
  const meter = new LatencyMeter();
  meter.inputSent(5, 0);
  meter.frameDrawn(5, 30);
  meter.inputSent(6, 40);
  meter.reset();
  assert.equal(meter.frameDrawn(6, 90), null);
  meter.inputSent(1, 100);
  meter.reset();
  meter.inputSent(1, 200);
  assert.equal(meter.frameDrawn(1, 250), 50);
});

test("rates are averages over the window and zero without frames", () => {
  const meter = new RateMeter(1000);
  for (let at = 0; at <= 2000; at += 50) meter.add(at, 10_000);
  const { fps, bytesPerSecond } = meter.read(2000);
  assert.ok(Math.abs(fps - 20) < 1e-9);
  assert.ok(Math.abs(bytesPerSecond - 200_000) < 1e-6);
  assert.deepEqual(meter.read(4000), { fps: 0, bytesPerSecond: 0 });
});

function frameMessage(seq: number, rev = 0, width = 0): ArrayBuffer {
  const buffer = new ArrayBuffer(68);
  new Uint8Array(buffer).set([0x48, 0x56, 0x52, 0x46, 1, 1, 1, 0]);
  const view = new DataView(buffer);
  view.setUint16(8, 64, true);
  view.setUint32(12, seq, true);
  view.setUint32(24, rev, true);
  view.setUint16(36, width, true);
  view.setUint8(64, seq);
  return buffer;
}

/** A pipeline whose decoder finishes on demand. */
function pipeline(sizeTimeoutMs?: number) {
  const log: string[] = [];
  const finish: ((works: boolean) => void)[] = [];
  const frames = new FramePipeline(
    {
      draw: (_, frame) => log.push(`draw ${frame.frameSeq}`),
      acknowledge: (seq) => log.push(`ack ${seq}`),
      failed: (message) => log.push(message),
    },
    (bytes) =>
      new Promise((resolve, reject) => {
        log.push(`decode ${bytes[0]}`);
        finish.push((works) => (works ? resolve({} as ImageBitmap) : reject(new Error("bad"))));
      }),
    sizeTimeoutMs,
  );
  const decoded = async (works = true): Promise<void> => {
    finish.shift()?.(works);
    await new Promise((resolve) => setTimeout(resolve, 0));
  };
  return { frames, log, decoded };
}

test("during decoding only the newest frame is queued, and all are acknowledged", async () => {
  const { frames, log, decoded } = pipeline();
  for (const seq of [1, 2, 3]) frames.push(frameMessage(seq));
  await decoded();
  await decoded();
  assert.deepEqual(log, ["decode 1", "ack 2", "draw 1", "ack 1", "decode 3", "draw 3", "ack 3"]);
});

test("an undecodable frame is reported, acknowledged and does not block the next", async () => {
  const { frames, log, decoded } = pipeline();
  frames.push(frameMessage(1));
  await decoded(false);
  frames.push(frameMessage(2));
  await decoded();
  assert.deepEqual(log, [
    "decode 1",
    "it could not be decoded as image/jpeg",
    "ack 1",
    "decode 2",
    "draw 2",
    "ack 2",
  ]);
});

test("an invalid frame message is reported and ignored", () => {
  const { frames, log } = pipeline();
  frames.push(new ArrayBuffer(3));
  assert.deepEqual(log, ["frame message of 3 bytes has no full header"]);
});

test("held frames are drawn or skipped on release, and all are acknowledged", async () => {
  const { frames, log, decoded } = pipeline();
  frames.hold();
  for (const seq of [1, 2]) frames.push(frameMessage(seq, 7));
  assert.deepEqual(log, ["ack 1"]);
  frames.release({ oldestRev: 7 });
  await decoded();
  assert.deepEqual(log.splice(0), ["ack 1", "decode 2", "draw 2", "ack 2"]);
  frames.hold();
  frames.push(frameMessage(3, 7));
  frames.release({ oldestRev: 8 });
  frames.push(frameMessage(4, 7));
  assert.deepEqual(log, ["ack 3", "ack 4"]);
});

test("a new page waits for a frame of the requested size", async () => {
  const { frames, log, decoded } = pipeline();
  frames.hold();
  frames.push(frameMessage(1, 3, 640));
  frames.release({ oldestRev: 0, size: { width: 800, height: 0 } });
  frames.push(frameMessage(2, 3, 640));
  frames.push(frameMessage(3, 3, 800));
  await decoded();
  assert.deepEqual(log.splice(0), ["ack 1", "ack 2", "decode 3", "draw 3", "ack 3"]);
  frames.push(frameMessage(4, 3, 640)); // another viewer may choose another size later
  await decoded();
  assert.deepEqual(log, ["decode 4", "draw 4", "ack 4"]);
  frames.clear();
});

test("after the size timeout a frame of another size is drawn", async () => {
  const { frames, log } = pipeline(1);
  frames.hold();
  frames.release({ oldestRev: 0, size: { width: 800, height: 0 } });
  frames.push(frameMessage(1, 3, 640));
  assert.equal(log[0], "ack 1");
  while (log.length < 2) await new Promise((resolve) => setTimeout(resolve, 1));
  assert.deepEqual(log, ["ack 1", "decode 1"]);
  frames.clear();
});
