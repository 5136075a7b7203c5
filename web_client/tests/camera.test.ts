import assert from "node:assert/strict";
import test from "node:test";
import type { Vector3 } from "heliograph/json.ts";
import type { CameraPose } from "../src/common/camera_pose.ts";
import { length, subtract } from "../src/common/vector.ts";
import {
  dolly,
  fitBeside,
  orbit,
  orbitAround,
  pan,
  seenFrom,
  visibleHeight,
  zoomTo,
} from "../src/view/camera.ts";
import { ZoomAnchor } from "../src/view/zoom_anchor.ts";

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

test("zooming to a surface keeps its direction and never passes it", () => {
  const surface: Vector3 = [1, 0.5, 2];
  const direction = (camera: CameraPose): Vector3 => {
    const offset = subtract(surface, camera.eye);
    return offset.map((value) => value / length(offset)) as Vector3;
  };
  let camera = front;
  for (let step = 0; step < 60; step += 1) camera = zoomTo(camera, 0.7, surface, [0.01, 100]);
  near(direction(camera), direction(front), 1e-6);
  const distance = length(subtract(surface, camera.eye));
  assert.ok(Math.abs(distance - 0.01) < 1e-9, `${distance}`);
  assert.ok(camera.eye[2] > surface[2]);
  near(zoomTo(front, 1000, surface, [0.01, 100]).eye, [-30.23, -15.12, 95.7], 0.05);
});

test("a camera that is too close to a surface stays where it is", () => {
  assert.deepEqual(zoomTo(front, 0.5, [0, 0, 4.99], [0.1, 100]).eye, front.eye);
});

test("until the surface is known the view comes no closer than by its part", async () => {
  let answer: (point: Vector3 | null) => void = () => {};
  let asked = 0;
  const resumed: [number, Vector3 | null][] = [];
  const anchor = new ZoomAnchor(
    () => {
      asked += 1;
      return new Promise((resolve) => (answer = resolve));
    },
    (factor, point) => resumed.push([factor, point]),
  );
  assert.equal(anchor.under(0.5, 0.5), null);
  let zoomed = 1;
  for (let step = 0; step < 20; step += 1) {
    assert.equal(anchor.under(0.502, 0.5), null, "the pointer rests");
    zoomed *= anchor.limit(0.8);
  }
  assert.ok(Math.abs(zoomed - 0.6) < 1e-9, `${zoomed}`);
  answer([1, 2, 3]);
  await Promise.resolve();
  assert.deepEqual(anchor.under(0.5, 0.5), [1, 2, 3]);
  assert.equal(anchor.limit(0.8), 0.8);
  const [[held, surface] = []] = resumed;
  assert.ok(Math.abs((held ?? 0) - 0.8 ** 20 / 0.6) < 1e-9, "what was held back follows");
  assert.deepEqual(surface, [1, 2, 3]);
  assert.equal(asked, 1);
  assert.equal(anchor.under(0.6, 0.5), null, "another point");
  assert.equal(asked, 2);
});

/** Where a point is seen: right and up by distance along the view direction. */
function seen(camera: CameraPose, point: Vector3): [right: number, up: number] {
  const minus = (a: Vector3, b: Vector3): Vector3 => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
  const forward = minus(camera.target, camera.eye);
  const size = Math.hypot(...forward);
  const [x, y, z] = forward.map((value) => value / size) as Vector3;
  const level = Math.hypot(x, z);
  const rightward: Vector3 = [-z / level, 0, x / level];
  const upward: Vector3 = [
    rightward[1] * z - rightward[2] * y,
    rightward[2] * x - rightward[0] * z,
    rightward[0] * y - rightward[1] * x,
  ];
  const [a, b, c] = minus(point, camera.eye);
  const along = (v: Vector3): number => a * v[0] + b * v[1] + c * v[2];
  const depth = along([x, y, z]);
  return [along(rightward) / depth, along(upward) / depth];
}

test("an orbit around a point keeps its place in the image and its distance", () => {
  const start: CameraPose = {
    eye: [0, 1, 6],
    target: [0, 0.5, 0],
    up: [0, 1, 0],
    vertical_fov: 45,
    name: null,
  };
  const pivot: Vector3 = [1.5, 1, 2];
  const turned = orbitAround(start, pivot, 0.7, 0.3);
  const [before, after] = [seen(start, pivot), seen(turned, pivot)];
  before.forEach((value, axis) => assert.ok(Math.abs(value - after[axis]!) < 1e-9));
  const distance = ({ eye }: CameraPose): number =>
    Math.hypot(...eye.map((value, axis) => value - pivot[axis]!));
  assert.ok(Math.abs(distance(turned) - distance(start)) < 1e-9);
  assert.ok(Math.hypot(turned.eye[0] - start.eye[0], turned.eye[2] - start.eye[2]) > 1);
});

test("a fit beside the panel centres the scene in the part that is not covered", () => {
  const start: CameraPose = {
    eye: [0, 0, 10],
    target: [0, 0, 0],
    up: [0, 1, 0],
    vertical_fov: 60,
    name: null,
  };
  const fitted = fitBeside(start, 1.5, 1.5, 0.5);
  const [right] = seen(fitted, [0, 0, 0]);
  // In fractions of half the width: the centre of the left half.
  assert.ok(Math.abs(right / (Math.tan(Math.PI / 6) * 1.5) + 0.5) < 1e-9, `${right}`);
  assert.ok(fitted.eye[2] > 10, "the scene is narrower than the view");
  assert.ok(Math.abs(fitBeside(start, 3, 3, 0.1).eye[2] - 10) < 1e-9);
  // A phone that shows the middle of a wide frame: half as wide as high.
  const cropped = fitBeside(start, 1.5, 0.5, 0);
  const narrow = Math.sin(Math.atan(Math.tan(Math.PI / 6) * 0.5));
  assert.ok(Math.abs(cropped.eye[2] - (10 * Math.sin(Math.PI / 6)) / narrow) < 1e-9);
});

test("views from the sides keep target and distance, and have an up direction", () => {
  const camera = { ...front, target: [1, 2, 3] as Vector3, eye: [4, 6, 3] as Vector3 };
  assert.deepEqual(seenFrom(camera, "right").eye, [6, 2, 3]);
  assert.deepEqual(seenFrom(camera, "back").eye, [1, 2, -2]);
  const top = seenFrom(camera, "top");
  assert.deepEqual([top.eye, top.target, top.up], [[1, 7, 3], [1, 2, 3], [0, 0, -1]]);
  const turned = orbit(top, 0, -0.2);
  assert.ok(turned.eye[2] > 3 && Math.abs(turned.eye[0] - 1) < 1e-9, "orbiting goes on to the front");
});
