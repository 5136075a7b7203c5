// The view: shows the server's frames and follows user input.

import assert from "node:assert/strict";
import { writeFileSync } from "node:fs";
import { join } from "node:path";
import {
  distance,
  dragView,
  eventually,
  figure,
  openTab,
  viewScreenshot,
  staticCamera,
  screenshot,
  settle,
} from "./harness/browser.mjs";
import { outputFolder } from "./harness/environment.mjs";
import { difference, statistics, thumbnail } from "./harness/images.mjs";
import { Stage } from "./harness/stage.mjs";

const stage = new Stage({ samples: 16, resolution: "half" });

async function viewImage(page, name) {
  return thumbnail(page, await viewScreenshot(page, name));
}

async function eye() {
  return (await stage.server.call("camera.get")).eye;
}

stage.test("the page has a content security policy", async () => {
  const { response } = await stage.sharedViewer();
  const policy = response.headers()["content-security-policy"] ?? "";
  assert.match(policy, /default-src 'self'/);
  assert.doesNotMatch(policy, /unsafe/);
});

stage.test("the first frame equals a capture of the server", async () => {
  const { page } = await stage.sharedViewer();
  await settle(page, stage.server);
  const seen = await viewImage(page, "first_frame");
  const { deviation } = statistics(seen);
  assert.ok(deviation > 0.03, `the frame is nearly uniform: deviation ${deviation}`);

  const capture = await stage.server.call("frame.capture", { buffer: "output", format: "png" });
  const png = Buffer.from(capture.data, "base64");
  writeFileSync(join(outputFolder, "first_frame_captured.png"), png);
  const change = difference(seen, await thumbnail(page, png));
  assert.ok(change < 0.05, `screen and capture differ by ${change}`);
  await screenshot(page, "first_frame_with_panel");
});

stage.test("the frame has the aspect ratio of the window and follows a resize", async () => {
  const { page } = await stage.sharedViewer();
  const aspect = async () => {
    const [width, height] = (await figure(page, "frame_size")).split("×").map(Number);
    return width / height;
  };
  assert.ok(Math.abs((await aspect()) - 960 / 540) < 0.02);
  await page.setViewportSize({ width: 600, height: 540 });
  await eventually(async () => Math.abs((await aspect()) - 600 / 540) < 0.02, "a resized frame");
  await page.setViewportSize({ width: 960, height: 540 });
  await eventually(async () => Math.abs((await aspect()) - 960 / 540) < 0.02, "a resized frame");
});

stage.test("dragging orbits, and the latency is shown", async () => {
  const { page } = await stage.sharedViewer();
  await settle(page, stage.server);
  const before = await viewImage(page, "before_orbit");
  const eyeBefore = await eye();
  await dragView(page, { x: 300, y: 400 }, { x: 520, y: 440 });
  const changed = await eventually(async () => {
    const change = difference(before, await viewImage(page, "after_orbit"));
    return change > 0.01 && change;
  }, "a changed frame");
  assert.ok(changed > 0.01);
  const eyeAfter = await eye();
  assert.ok(distance(eyeAfter, eyeBefore) > 0.01, "the camera of the session has not moved");
  const latency = await eventually(async () => {
    const text = await figure(page, "latency");
    return /^\d+ ms$/.test(text) && text;
  }, "a latency figure");
  assert.ok(Number.parseFloat(latency) < 30_000, latency);
});

stage.test("wheel, keyboard and right drag move the camera, F fits it", async () => {
  const { page } = await stage.sharedViewer();
  const expectMove = async (what, action) => {
    const start = JSON.stringify((await staticCamera(page, stage.server)).eye);
    await action();
    await eventually(async () => JSON.stringify(await eye()) !== start, what);
  };
  await page.mouse.move(400, 400);
  await expectMove("a dolly", () => page.mouse.wheel(0, 240));
  await expectMove("a pan", async () => {
    await page.mouse.down({ button: "right" });
    await page.mouse.move(460, 380, { steps: 5 });
    await page.mouse.up({ button: "right" });
  });
  await page.locator("#view").focus();
  await expectMove("an orbit by key", () => page.keyboard.press("ArrowLeft", { delay: 120 }));
  await expectMove("a fit", () => page.keyboard.press("f"));
});

stage.test("pass timings are shown", async () => {
  const { page } = await stage.sharedViewer();
  const { buffers } = await stage.server.call("frame.buffers");
  assert.equal(buffers[0].name, "output");
  await dragView(page, { x: 400, y: 400 }, { x: 430, y: 400 });
  await openTab(page, "timing");
  await page.waitForSelector(".pass", { timeout: 20_000 });
  const rows = await page.locator(".pass .pass-ms").allInnerTexts();
  assert.ok(rows.length >= 3, `only ${rows.length} passes`);
  assert.ok(rows.some((text) => Number(text) > 0));
  assert.match(await figure(page, "frame_time"), /\d ms$/);
});
