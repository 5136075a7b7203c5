import assert from "node:assert/strict";
import test from "node:test";
import type { Vector3 } from "heliograph/json.ts";
import type { CameraPose } from "../../src/common/camera_pose.ts";
import { add, length, scale, subtract } from "../../src/common/vector.ts";
import {
  metresAcross,
  metresAlong,
  rotated,
  sideOf,
  tipOffset,
  turned,
} from "../../src/gizmos/drag_math.ts";
import { dragged, stepped } from "../../src/gizmos/pose.ts";
import { Projection } from "../../src/view/projection.ts";

const camera: CameraPose = {
  eye: [3, 4, 10],
  target: [0, 1, 0],
  up: [0, 1, 0],
  vertical_fov: 50,
  name: null,
};
const projection = new Projection(camera, 2, 800, 400);
/** Along -Z: at a distance of 10 m, 20 pixels are a metre. */
const straight = new Projection(
  { ...camera, eye: [0, 0, 10], target: [0, 0, 0], vertical_fov: 90 },
  2,
  800,
  400,
);

function near(actual: Vector3 | null, expected: Vector3): void {
  assert.ok(actual && length(subtract(actual, expected)) < 1e-9, `${actual}, not ${expected}`);
}

test("a point moves over the view as the difference of two places tells", () => {
  const [at, along]: Vector3[] = [
    [0.5, 1.5, -1],
    [0.6, 0, 0.8],
  ];
  const [a, b] = [-1, 1].map((sign) => projection.point(add(at!, scale(along!, sign * 1e-5))));
  const motion = projection.motion(at!, along!);
  assert.ok(a && b && motion);
  assert.ok(Math.abs((b.x - a.x) / 2e-5 - motion.x) < 1e-3);
  assert.ok(Math.abs((b.y - a.y) / 2e-5 - motion.y) < 1e-3);
  assert.equal(projection.motion([6, 8, 21], along!), null, "behind the eye");
  assert.ok(Math.abs(straight.pixelsPerMetre([3, 1, 0]) - 20) < 1e-9);
  assert.equal(straight.pixelsPerMetre([0, 0, 11]), 0);
});

test("a point that is dragged along an axis stays under the pointer", () => {
  for (const axis of [[1, 0, 0], [0, 1, 0], [0, 0, 1]] as Vector3[]) {
    let at: Vector3 = [0, 1, 0];
    const start = projection.point(at)!;
    const motion = projection.motion(at, axis)!;
    const size = Math.hypot(motion.x, motion.y);
    const delta = { x: (2 * motion.x) / size, y: (2 * motion.y) / size };
    for (let i = 0; i < 30; i += 1) {
      at = add(at, scale(axis, metresAlong(projection, at, axis, delta)));
    }
    const end = projection.point(at)!;
    assert.ok(Math.hypot(end.x - start.x - 30 * delta.x, end.y - start.y - 30 * delta.y) < 2);
    const across = metresAlong(projection, [0, 1, 0], axis, { x: -delta.y, y: delta.x });
    assert.ok(Math.abs(across) < 1e-9, "across the axis nothing moves");
  }
});

test("an axis that points at the eye moves slowly, not infinitely fast", () => {
  const away = metresAlong(straight, [0, 0, 0], [0, 0, 1], { x: 0, y: 10 });
  assert.ok(Math.abs(away - 2) < 1e-9, `${away}`);
  assert.equal(metresAlong(straight, [0, 0, 11], [1, 0, 0], { x: 5, y: 0 }), 0);
});

test("a drag across the view keeps the distance and the pointer", () => {
  const at: Vector3 = [1, 2, 0];
  const moved = add(at, metresAcross(projection, at, { x: 37, y: -21 }));
  const [before, after] = [projection.point(at)!, projection.point(moved)!];
  assert.ok(Math.abs(after.x - before.x - 37) < 1e-6);
  assert.ok(Math.abs(after.y - before.y + 21) < 1e-6);
  near(metresAcross(straight, [0, 0, 0], { x: 20, y: 40 }), [1, -2, 0]);
});

test("a direction turns by two angles of the view", () => {
  const quarter = Math.PI / 2;
  near(rotated([1, 0, 0], [0, 0, 1], quarter), [0, 1, 0]);
  const view = straight.directions;
  near(turned([0, 0, 1], view, { right: quarter, up: 0 }, 1), [1, 0, 0]);
  near(turned([0, 0, 1], view, { right: 0, up: quarter }, 1), [0, 1, 0]);
  const any = turned([0.6, 0, 0.8], projection.directions, { right: 1.1, up: -0.4 }, 1);
  assert.ok(Math.abs(length(any) - 1) < 1e-12);
  assert.equal(sideOf([0, 0, 1], view.forward), 1);
  assert.equal(sideOf([0, 0, -1], view.forward), -1);
});

test("the tip of a direction follows the pointer, wherever it is", () => {
  const view = straight.directions;
  const tips: Vector3[] = [[0, -1, 0], [0.6, 0, 0.8], [0, 0.8, -0.6], [0.5, 0.5, Math.SQRT1_2]];
  for (const tip of tips) {
    const radius = Math.hypot(tip[0], tip[1]);
    const [x, y] = [(-0.01 * tip[1]) / radius, (0.01 * tip[0]) / radius]; // around the middle
    const after = turned(tip, view, { right: x, up: y }, sideOf(tip, view.forward));
    assert.ok(Math.hypot(after[0] - tip[0] - x, after[1] - tip[1] - y) < 2e-4, `${tip}: ${after}`);
  }
});

test("tips have the same size at every distance, and never lie on their anchor", () => {
  const sizes = { reach: 90, least: 40 };
  for (const anchor of [[0, 0, 0], [0, 0, -200]] as Vector3[]) {
    const across = tipOffset(straight, anchor, [1, 0, 0], sizes)!;
    assert.ok(Math.abs(across.x - 90) < 1e-6 && Math.abs(across.y) < 1e-6);
    assert.deepEqual(tipOffset(straight, anchor, [0, 0, 1], sizes), { x: 0, y: 40 });
  }
  assert.equal(tipOffset(straight, [0, 0, 11], [1, 0, 0], sizes), null);
});

test("drags and keys change what their handle is for", () => {
  const pose = { anchor: [0, 0, 0] as Vector3, direction: [0, 0, 1] as Vector3 };
  const hand = { reach: 100, side: 1 } as const;
  const along = { kind: "along", tip: [0, 1, 0] as Vector3 } as const;
  const up = dragged(pose, along, straight, { x: 15, y: -20 }, hand);
  near(up.anchor, [0, 1, 0]);
  near(up.direction, pose.direction);
  const turn = { kind: "turn", tip: pose.direction, opposite: false } as const;
  const right = dragged(pose, turn, straight, { x: 50 * Math.PI, y: 0 }, hand);
  near(right.direction, [1, 0, 0]);
  near(right.anchor, pose.anchor);
  // A tip behind its anchor follows the pointer, too.
  const back = { anchor: pose.anchor, direction: [0, 0, -1] as Vector3 };
  const behind = dragged(back, turn, straight, { x: 50 * Math.PI, y: 0 }, { ...hand, side: -1 });
  near(behind.direction, [1, 0, 0]);
  const opposite = { kind: "turn", tip: back.direction, opposite: true } as const;
  const far = dragged(pose, opposite, straight, { x: 50 * Math.PI, y: 0 }, { ...hand, side: -1 });
  near(far.direction, [-1, 0, 0]);
  near(stepped(pose, along, straight, { right: 0.5, up: 0 }, 1).anchor, [0, 0.5, 0]);
  const across = { kind: "across", tip: null } as const;
  near(stepped(pose, across, straight, { right: 0.5, up: 0.25 }, 1).anchor, [0.5, 0.25, 0]);
  const turnedUp = stepped(pose, turn, straight, { right: 0, up: Math.PI / 2 }, 1);
  near(turnedUp.direction, [0, 1, 0]);
});
