import assert from "node:assert/strict";
import test from "node:test";
import type { Snap } from "heliograph/messages.ts";
import type { CameraPose } from "../src/common/camera_pose.ts";
import { type PointTask, PointTool } from "../src/view/point_tool.ts";
import { Projection } from "../src/view/projection.ts";

const camera: CameraPose = {
  eye: [0, 0, 10],
  target: [0, 0, 0],
  up: [0, 1, 0],
  vertical_fov: 90,
  name: null,
};
const near = (actual: number, expected: number): void =>
  assert.ok(Math.abs(actual - expected) < 1e-9, `${actual}, not ${expected}`);

test("points are where a perspective camera shows them", () => {
  const projection = new Projection(camera, 2, 800, 400);
  assert.deepEqual(projection.point([0, 0, 0]), { x: 400, y: 200 });
  const corner = projection.point([20, 10, 0]);
  near(corner?.x ?? 0, 800);
  near(corner?.y ?? 0, 0);
  assert.equal(projection.point([0, 0, 11]), null);
});

test("a view of another shape shows the middle of the frame", () => {
  const tall = new Projection(camera, 2, 200, 400).point([0, 10, 0]);
  near(tall?.y ?? 1, 0);
  const wide = new Projection(camera, 2, 1600, 400).point([20, 0, 0]);
  near(wide?.x ?? 0, 1600);
});

test("lines that pass the eye end before it", () => {
  const projection = new Projection(camera, 2, 800, 400);
  const line = projection.line([1, 0, 0], [1, 0, 20]);
  assert.ok(line);
  near(line[0].x, 420);
  assert.ok(line[1].x > 800 && Number.isFinite(line[1].x), "it leaves the view");
  assert.equal(projection.line([0, 0, 11], [0, 5, 12]), null);
});

/** A tool over a surface at which every point is a hit but those at the left. */
function toolAt(): { tool: PointTool; free: boolean[] } {
  const free: boolean[] = [];
  const canvas = { addEventListener: () => {} } as unknown as HTMLElement;
  const tool = new PointTool({
    canvas,
    picker: { onClick: () => {}, mark: () => {}, unmark: () => {} },
    snap: async (x, y, isFree) => {
      free.push(isFree);
      if (x < 0.1) return null;
      return { hit: true, position: [x, y, 0], normal: null, feature: "face", surface: null };
    },
  });
  return { tool, free };
}

test("a task takes its points, then begins again", async () => {
  const { tool, free } = toolAt();
  const done: Snap[][] = [];
  const task: PointTask = {
    name: "distance",
    count: 2,
    repeats: true,
    snaps: true,
    done: (points) => done.push(points),
  };
  tool.start(task);
  await tool.place(0.05, 0.5, false);
  assert.equal(tool.points.value.length, 0, "there is no surface");
  await tool.place(0.2, 0.5, false);
  await tool.place(0.3, 0.5, true);
  assert.deepEqual(done.map((points) => points.length), [2]);
  assert.deepEqual(free, [false, false, true]);
  assert.equal(tool.task.value, task);
  await tool.place(0.4, 0.5, false);
  tool.cancel();
  assert.equal(tool.points.value.length, 0);
  assert.equal(tool.task.value, task, "the first cancel drops the points");
  tool.cancel();
  assert.equal(tool.task.value, null);
});

test("a task that does not repeat ends with its last point", async () => {
  const { tool, free } = toolAt();
  let count = 0;
  const done = (): void => void (count += 1);
  tool.start({ name: "annotation", count: 1, repeats: false, snaps: false, done });
  await tool.place(0.5, 0.5, false);
  assert.equal(count, 1);
  assert.deepEqual(free, [true], "nothing attracts its point");
  assert.equal(tool.task.value, null);
});
