import assert from "node:assert/strict";
import test from "node:test";
import { fieldOfView, focalLength } from "../../src/panel/scene/lens_fields.ts";

test("a field of view is a focal length before a sensor", () => {
  // Of a full frame, 24 mm high: 50 mm see 27 degrees.
  assert.ok(Math.abs(fieldOfView(24, 50) - 26.99) < 0.01);
  assert.ok(Math.abs(focalLength(24, 90) - 12) < 1e-9);
  assert.ok(Math.abs(focalLength(36, fieldOfView(36, 85)) - 85) < 1e-9);
});
