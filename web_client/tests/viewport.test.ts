import assert from "node:assert/strict";
import test from "node:test";
import { frameSize } from "../src/view/viewport.ts";

const limits = { maxWidth: 3840, maxHeight: 2160, maxPixels: Infinity };

test("a frame has the view's device pixels, at most two per CSS pixel", () => {
  assert.deepEqual(frameSize(800, 600, 1, limits), { width: 800, height: 600 });
  assert.deepEqual(frameSize(360, 740, 3, limits), { width: 720, height: 1480 });
});

test("limits reduce the size and keep the aspect ratio", () => {
  assert.deepEqual(frameSize(2560, 1440, 2, limits), { width: 3840, height: 2160 });
  const tall = frameSize(500, 2000, 2, limits);
  assert.deepEqual(tall, { width: 540, height: 2160 });
  const frugal = frameSize(1440, 900, 1, { ...limits, maxPixels: 589_824 });
  assert.ok(frugal.width * frugal.height <= 590_500);
  assert.ok(Math.abs(frugal.width / frugal.height - 1.6) < 0.01);
});

test("a view of size zero still gives a valid frame size", () => {
  assert.deepEqual(frameSize(0, 0, 1, limits), { width: 16, height: 16 });
});
