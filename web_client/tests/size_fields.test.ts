import assert from "node:assert/strict";
import test from "node:test";
import { resized } from "../src/output/size_fields.ts";

const view = { width: 800, height: 400 };
const limits = { width: 3840, height: 2160 };

test("a linked side follows the other one", () => {
  assert.deepEqual(resized(view, "width", 1600, 2, limits), { width: 1600, height: 800 });
  assert.deepEqual(resized(view, "height", 1000, 2, limits), { width: 2000, height: 1000 });
  assert.deepEqual(resized(view, "height", 1000, null, limits), { width: 800, height: 1000 });
});

test("both sides keep the server's limits, and the aspect ratio", () => {
  assert.deepEqual(resized(view, "width", 9000, 2, limits), { width: 3840, height: 1920 });
  assert.deepEqual(resized(view, "height", 9000, 0.5, limits), { width: 1080, height: 2160 });
  assert.deepEqual(resized(view, "width", 9000, null, limits), { width: 3840, height: 400 });
  assert.deepEqual(resized(view, "width", 1, 2, limits), { width: 32, height: 16 });
});
