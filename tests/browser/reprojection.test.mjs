// Between frames of the server the view follows the pointer: the newest frame, as seen from the new
// camera. In lockstep no frame comes before the test asks for it.

import assert from "node:assert/strict";
import {
  dragView,
  eventually,
  figure,
  openTab,
  prepareWorker,
  staticCamera,
  viewScreenshot,
} from "./harness/browser.mjs";
import { difference, thumbnail } from "./harness/images.mjs";
import { Stage } from "./harness/stage.mjs";

const h264 = 16; // codec of frames
const drag = [
  { x: 300, y: 300 },
  { x: 316, y: 304 },
];

// Without inertia the view rests where the pointer does.
const stage = new Stage({ resolution: "half", view: { reducedMotion: "reduce" } });

const seen = (page) => page.evaluate(() => window.seen);
const view = async (page, name) => thumbnail(page, await viewScreenshot(page, name));

/** Has the server render and waits until the page shows the last of these frames. */
async function step(page, frames = 8) {
  const { frame } = await seen(page);
  const { rev } = await stage.server.call("frame.step", { frames, dt: 0.02 });
  await page.waitForFunction(
    ([minimum, before]) => {
      const { frame: newest } = window.seen;
      return newest.stateRev >= minimum && newest.frameSeq > before;
    },
    [rev, frame.frameSeq],
  );
}

/** A page whose session renders frames only when asked to. */
async function watchStepped(options) {
  await stage.server.call("frame.run").catch(() => {}); // it is in no lockstep at first
  const viewer = await stage.watch(options);
  await step(viewer.page);
  return viewer;
}

/** Drags; how far the view is then off what the server renders, with and without reprojection. */
async function dragged(page, name) {
  const before = await view(page, `${name}_before`);
  const { frame } = await seen(page);
  await dragView(page, ...drag);
  await staticCamera(page, stage.server);
  assert.equal((await seen(page)).frame.frameSeq, frame.frameSeq, "the server has sent a frame");
  const followed = await view(page, `${name}_followed`);
  await step(page);
  const rendered = await view(page, `${name}_rendered`);
  const off = { still: difference(before, rendered), followed: difference(followed, rendered) };
  assert.ok(off.still > 0.004, `the drag changes little: ${off.still}`);
  return off;
}

stage.test("the view follows the pointer before the server has rendered", async () => {
  const { page } = await watchStepped();
  const { still, followed } = await dragged(page, "reprojected");
  assert.ok(followed < 0.7 * still, `off by ${followed}; by ${still} without reprojection`);
  const { predicted } = await seen(page);
  assert.ok(predicted >= 2, `${predicted} images for a drag of 12 events`);
  await step(page);
  assert.equal((await seen(page)).predicted, predicted, "a frame of the server was reprojected");
  await openTab(page, "timing");
  await eventually(async () => /^\d+ ms$/.test(await figure(page, "response")), "a response time");
});

stage.test("so it does while H.264 is streamed", async (t) => {
  const context = await stage.context({ stored: { codec: "h264" } });
  const { page } = await watchStepped({ context });
  if (!(await seen(page)).drawn[h264]) return t.skip("server or browser has no H.264");
  const { still, followed } = await dragged(page, "reprojected_video");
  assert.ok(followed < 0.7 * still, `off by ${followed}; by ${still} without reprojection`);
});

stage.test("a camera that another viewer moves is shown when the server has rendered it", async () => {
  const { page } = await watchStepped();
  const before = await view(page, "other_before");
  await dragView(page, ...drag);
  await staticCamera(page, stage.server);
  assert.ok((await seen(page)).predicted > 0);
  await stage.server.call("camera.orbit", { yaw: 20 });
  await eventually(async () => (await seen(page)).camera, "the other camera");
  await eventually(
    async () => difference(before, await view(page, "other_moved")) < 0.002,
    "the frame as it was rendered",
  );
  await step(page);
});

stage.test("without WebGL2 the page shows the frames of the server", async () => {
  const context = await stage.context();
  await prepareWorker(
    context,
    `const original = OffscreenCanvas.prototype.getContext;
     OffscreenCanvas.prototype.getContext = function (kind, ...rest) {
       return kind === "webgl2" ? null : original.call(this, kind, ...rest);
     };`,
  );
  const { page } = await watchStepped({ context });
  const { still, followed } = await dragged(page, "no_webgl");
  assert.ok(Math.abs(followed - still) < 0.2 * still, `${followed}, ${still}`);
  assert.equal((await seen(page)).predicted, 0);
  await openTab(page, "timing");
  assert.equal(await page.locator("[name=reprojection]").isChecked(), false);
});
