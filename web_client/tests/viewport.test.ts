import assert from "node:assert/strict";
import test from "node:test";
import { frameSize, pointInFrame } from "../src/view/viewport.ts";

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

test("a view shows the middle of a frame of another shape", () => {
  const wide = { width: 1600, height: 900 };
  assert.deepEqual(pointInFrame(wide, { width: 800, height: 450 }, 0.2, 0.7), { x: 0.2, y: 0.7 });
  const narrow = pointInFrame({ width: 450, height: 900 }, wide, 0, 0.7);
  assert.ok(Math.abs(narrow.x - (0.5 - 450 / 3200)) < 1e-12);
  assert.equal(narrow.y, 0.7);
  const low = pointInFrame({ width: 1600, height: 450 }, wide, 0.2, 1);
  assert.ok(Math.abs(low.y - 0.75) < 1e-12);
  assert.equal(low.x, 0.2);
});
