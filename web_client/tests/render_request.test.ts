import assert from "node:assert/strict";
import test from "node:test";
import { duration, previewKind, progressText, summaryText, type Job } from "../src/jobs/job_texts.ts";
import { type RenderWish, leftOut, renderJob } from "../src/output/render_request.ts";
import type { CameraPose } from "../src/common/camera_pose.ts";
import type { ViewState } from "../src/session/view_state.ts";

const state: ViewState = {
  scene: "helmet",
  variant: "gold",
  environment: null,
  settings: { tone_map: { curve: "agx" }, view: { buffer: "output" } },
  clip: { clip: "walk", seconds: 1.5, rate: 1, playing: true },
  camera: { eye: [1, 2, 3], target: [0, 0.5, 0], up: [0, 1, 0], vertical_fov: 45, name: null },
};
const wish: RenderWish = {
  size: { width: 640, height: 360 },
  quality: 0.98,
  transparent: true,
  format: "png",
  turntable: null,
  path: null,
  fps: 30,
};

test("a job renders what the page shows", () => {
  const { entries, name } = renderJob(state, "helmet", wish);
  assert.equal(name, "helmet, 640 x 360");
  assert.deepEqual(entries, [
    {
      scene: "helmet",
      output: "helmet.png",
      format: "png",
      width: 640,
      height: 360,
      view: { eye: [1, 2, 3], target: [0, 0.5, 0], up: [0, 1, 0], vertical_fov: 45 },
      quality: 0.98,
      background: "transparent",
      settings: { tone_map: { curve: "agx" } },
      variant: "gold",
      clip: "walk",
      time: 1.5,
    },
  ]);
});

test("turntables are one video, or numbered images", () => {
  const video = renderJob(state, "a", { ...wish, turntable: 72, format: "mp4" }).entries[0];
  assert.deepEqual([video?.output, video?.turntable, video?.fps], ["a.mp4", 72, 30]);
  const animated = { ...wish, turntable: 36, format: "animated_webp" } as const;
  assert.equal(renderJob(state, "a", animated).entries[0]?.output, "a.webp");
  const images = renderJob(state, "a", { ...wish, turntable: 36 }).entries[0];
  assert.equal(images?.output, "a_{frame:04}.png");
});

test("a path is rendered in place of the view", () => {
  const [key, next] = [state.camera, { ...state.camera, eye: [4, 2, 3] }] as [CameraPose, CameraPose];
  const form = { smooth: true, closed: false };
  const path = { keys: [key, next], form, seconds: 4 };
  const { entries, name } = renderJob(state, "a", { ...wish, path, format: "mp4" });
  assert.equal(name, "a path, 640 x 360");
  assert.equal(entries[0]?.view, undefined);
  assert.deepEqual(entries[0]?.path?.keys[1]?.eye, [4, 2, 3]);
  assert.deepEqual([entries[0]?.path?.seconds, entries[0]?.fps], [4, 30]);
  const images = renderJob(state, "a", { ...wish, path }).entries[0];
  assert.equal(images?.output, "a_{frame:04}.png");
});

test("a job has the edits of the view", () => {
  const edits = { version: 1, hidden: [3], environment: { name: "sky" } };
  const [entry] = renderJob(state, "a", wish, edits).entries;
  assert.deepEqual(entry?.edits?.hidden, [3]);
  assert.equal(entry?.edits?.environment, undefined);
});

test("another buffer has neither quality nor background", () => {
  const settings = { view: { buffer: "gbuffer.normals" } };
  const [entry] = renderJob({ ...state, settings }, "a", wish).entries;
  assert.equal(entry?.buffer, "gbuffer.normals");
  assert.deepEqual([entry?.quality, entry?.background], [undefined, undefined]);
});

test("what a job cannot show is said", () => {
  assert.equal(leftOut(state), "");
  assert.match(leftOut({ ...state, part: 1 }), /the choice of a scene/);
  assert.throws(() => renderJob({ ...state, scene: undefined }, "a", wish), /no scene/);
});

const job = { images: 72, images_done: 18, attempts: 1, priority: 0, started: 100 } as Job;

test("the progress of a job has its time left", () => {
  const running = { ...job, state: "running" } as Job;
  assert.equal(progressText(running, 130), "18 of 72 images, about 1 min 30 s left");
  assert.equal(progressText({ ...running, images_done: 0 }, 130), "0 of 72 images");
  const queued = { ...job, state: "queued", priority: 5 } as Job;
  assert.equal(progressText(queued, 130), "72 images, priority 5, to be begun again");
  const done = { ...job, state: "done", images_done: 1, ended: 102, expires: 86_400 * 7 } as Job;
  assert.equal(progressText(done, 130), "1 image in 2 s, kept for 6 days");
  assert.equal(duration(3725), "1 h 2 min");
});

test("the summary tells how much room is left", () => {
  const list = { jobs: [], queued: 3, bytes: 48_210, quota: 4_294_967_296 };
  assert.equal(summaryText(list, 0), "3 waiting · 48 kB of 4.3 GB used");
  assert.equal(summaryText({ ...list, bytes: 0 }, 1), "1 running, 3 waiting · 0 kB of 4.3 GB used");
});

test("a browser shows images and videos", () => {
  const kinds = ["a.png", "b/c.MP4", "d.exr", "no_extension"].map(previewKind);
  assert.deepEqual(kinds, ["image", "video", "none", "none"]);
});
