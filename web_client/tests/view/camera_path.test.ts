import assert from "node:assert/strict";
import test from "node:test";
import type { Vector3 } from "heliograph/json.ts";
import type { CameraPose } from "../../src/common/camera_pose.ts";
import { cameraOnPath } from "../../src/view/camera_path.ts";

function key(eye: Vector3, target: Vector3 = [0, 0, 0], fov = 45): CameraPose {
  return { eye, target, up: [0, 1, 0], vertical_fov: fov, name: null };
}

function near(found: Vector3, expected: Vector3): void {
  found.forEach((value, i) => {
    assert.ok(Math.abs(value - (expected[i] as number)) < 1e-4, `${found.join()} not ${expected.join()}`);
  });
}

const keys = [
  key([0, 1, 4]),
  key([3, 2, 1], [0.5, 0, 0]),
  key([-1, 1, -3]),
  key([-4, 3, 0], [0, 0.5, 0], 60),
];

test("a path passes through its keys", () => {
  for (const smooth of [true, false]) {
    keys.forEach((each, i) => {
      const open = cameraOnPath(keys, { smooth, closed: false }, i / 3);
      if (!smooth || i === 0 || i === 3) near(open.eye, each.eye);
      near(cameraOnPath(keys, { smooth, closed: true }, i / 4).eye, each.eye);
    });
  }
});

// tests/unit/scene/camera/camera_path_test.cpp has the same figures for the server's code.
test("the page plays a path as the server renders it", () => {
  const open = cameraOnPath(keys, { smooth: true, closed: false }, 0.3);
  near(open.eye, [2.52075, 1.85003, 2.19914]);
  const closed = cameraOnPath(keys, { smooth: true, closed: true }, 0.9);
  near(closed.eye, [-2.08645, 1.94042, 3.58504]);
  assert.ok(Math.abs(closed.vertical_fov - 51.36) < 1e-3);
});

test("a path turns about its target instead of cutting across", () => {
  const around = cameraOnPath([key([0, 0, 4]), key([0, 0, -1])], { smooth: false, closed: false }, 0.5);
  assert.ok(Math.abs(Math.hypot(...around.eye) - 2) < 1e-4);
});
