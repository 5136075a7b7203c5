import assert from "node:assert/strict";
import test from "node:test";
import type { Vector3 } from "heliograph/json.ts";
import type { CameraPose } from "../src/common/camera_pose.ts";
import { length, subtract } from "../src/common/vector.ts";
import { dolly, orbit, pan, visibleHeight } from "../src/view/camera.ts";

const front: CameraPose = {
  eye: [0, 0, 5],
  target: [0, 0, 0],
  up: [0, 1, 0],
  vertical_fov: 90,
  name: "Front",
};

function near(actual: Vector3, expected: Vector3, tolerance = 1e-9): void {
  assert.ok(length(subtract(actual, expected)) < tolerance, `${actual} is not ${expected}`);
}

test("a quarter turn to the right puts the eye on +X", () => {
  const turned = orbit(front, Math.PI / 2, 0);
  near(turned.eye, [5, 0, 0]);
  near(turned.target, [0, 0, 0]);
});

test("positive pitch lifts the eye and keeps its distance", () => {
  const lifted = orbit(front, 0, Math.PI / 6);
  near(lifted.eye, [0, 2.5, 5 * Math.cos(Math.PI / 6)]);
});

test("the turntable stops before the pole and returns the same way", () => {
  const top = orbit(front, 0, 10);
  assert.ok(top.eye[1] < 5 && top.eye[1] > 4.99);
  const back = orbit(top, 0, -(89 * Math.PI) / 180);
  near(back.eye, front.eye, 1e-6);
});

test("a view from exactly above keeps its heading", () => {
  const above: CameraPose = { ...front, eye: [0, 5, 0], up: [0, 0, -1] };
  const tilted = orbit(above, 0, -0.5);
  assert.ok(tilted.eye[2] > 0 && Math.abs(tilted.eye[0]) < 1e-9, `${tilted.eye}`);
});

test("orbiting levels the horizon and leaves the named camera", () => {
  const rolled: CameraPose = { ...front, up: [0.5, 0.8, 0] };
  const turned = orbit(rolled, 0.1, 0);
  assert.deepEqual(turned.up, [0, 1, 0]);
  assert.equal(turned.name, null);
});

test("many small turns add up to one large one", () => {
  let camera = front;
  for (let step = 0; step < 360; step += 1) camera = orbit(camera, Math.PI / 180, 0);
  near(camera.eye, front.eye, 1e-9);
});

test("panning by the full height moves by what the view shows at the target", () => {
  const span = visibleHeight(90, 5);
  assert.ok(Math.abs(span - 10) < 1e-9);
  near(pan(front, 1, 0).target, [-10, 0, 0]); // the scene follows the pointer to the right
  near(pan(front, 0, 1).target, [0, 10, 0]); // and down
  const moved = pan(front, 0.3, -0.2);
  near(subtract(moved.eye, moved.target), [0, 0, 5]);
});

test("dolly scales the distance within its bounds", () => {
  near(dolly(front, 0.5, 0.1, 100).eye, [0, 0, 2.5]);
  near(dolly(front, 100, 0.1, 100).eye, [0, 0, 100]);
});

test("dolly beyond the nearest distance moves eye and target", () => {
  const close: CameraPose = { ...front, eye: [0, 0, 1] };
  const walked = dolly(close, 0.5, 1, 100);
  near(walked.eye, [0, 0, 0.5]);
  near(walked.target, [0, 0, -0.5]);
});
