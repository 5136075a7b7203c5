// The picture: it is there, it is the server's, and it follows the hand.

import assert from "node:assert/strict";
import { writeFileSync } from "node:fs";
import { join } from "node:path";
import {
  distance,
  dragPicture,
  eventually,
  figure,
  openTab,
  pictureScreenshot,
  restingCamera,
  screenshot,
  settle,
} from "./harness/browser.mjs";
import { outputFolder } from "./harness/environment.mjs";
import { difference, statistics, thumbnail } from "./harness/pictures.mjs";
import { Stage } from "./harness/stage.mjs";

const stage = new Stage();

async function lookAt(page, name) {
  return thumbnail(page, await pictureScreenshot(page, name));
}

async function eye() {
  return (await stage.server.call("camera.get")).eye;
}

stage.test("the page comes with a content security policy", async () => {
  const { response } = await stage.sharedViewer();
  const policy = response.headers()["content-security-policy"] ?? "";
  assert.match(policy, /default-src 'self'/);
  assert.doesNotMatch(policy, /unsafe/);
});

stage.test("the first picture is the scene that the server captures", async () => {
  const { page } = await stage.sharedViewer();
  await settle(page, stage.server);
  const seen = await lookAt(page, "first_picture");
  const { deviation } = statistics(seen);
  assert.ok(deviation > 0.03, `the picture is nearly blank: deviation ${deviation}`);

  const capture = await stage.server.call("frame.capture", { buffer: "output", format: "png" });
  const png = Buffer.from(capture.data, "base64");
  writeFileSync(join(outputFolder, "first_picture_captured.png"), png);
  const apart = difference(seen, await thumbnail(page, png));
  assert.ok(apart < 0.05, `screen and capture differ by ${apart}`);
  await screenshot(page, "first_picture_with_panel");
});

stage.test("the picture has the shape of the window and follows a resize", async () => {
  const { page } = await stage.sharedViewer();
  const shape = async () => {
    const [width, height] = (await figure(page, "picture")).split("×").map(Number);
    return width / height;
  };
  assert.ok(Math.abs((await shape()) - 960 / 540) < 0.02);
  await page.setViewportSize({ width: 600, height: 540 });
  await eventually(async () => Math.abs((await shape()) - 600 / 540) < 0.02, "a resized picture");
  await page.setViewportSize({ width: 960, height: 540 });
  await eventually(async () => Math.abs((await shape()) - 960 / 540) < 0.02, "a resized picture");
});

stage.test("dragging orbits and a latency figure appears", async () => {
  const { page } = await stage.sharedViewer();
  await settle(page, stage.server);
  const before = await lookAt(page, "before_orbit");
  const eyeBefore = await eye();
  await dragPicture(page, { x: 300, y: 400 }, { x: 520, y: 440 });
  const changed = await eventually(async () => {
    const apart = difference(before, await lookAt(page, "after_orbit"));
    return apart > 0.01 && apart;
  }, "a changed picture");
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
    const start = JSON.stringify((await restingCamera(page, stage.server)).eye);
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

stage.test("timings of the passes are shown", async () => {
  const { page } = await stage.sharedViewer();
  const { buffers } = await stage.server.call("frame.buffers");
  assert.equal(buffers[0].name, "output");
  await dragPicture(page, { x: 400, y: 400 }, { x: 430, y: 400 });
  await openTab(page, "stats");
  await page.waitForSelector(".pass", { timeout: 20_000 });
  const rows = await page.locator(".pass .pass-ms").allInnerTexts();
  assert.ok(rows.length >= 3, `only ${rows.length} passes`);
  assert.ok(rows.some((text) => Number(text) > 0));
  assert.match(await figure(page, "frame"), /\d ms$/);
});
