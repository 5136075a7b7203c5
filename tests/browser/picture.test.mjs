// The picture: it is there, it is the server's, and it follows the hand.

import assert from "node:assert/strict";
import { writeFileSync } from "node:fs";
import { join } from "node:path";
import test, { after, before } from "node:test";
import {
  dragPicture,
  eventually,
  figure,
  firstPicture,
  launchBrowser,
  openTab,
  openViewer,
  pictureScreenshot,
  screenshot,
  settle,
} from "./harness/browser.mjs";
import { outputFolder } from "./harness/environment.mjs";
import { difference, statistics, thumbnail } from "./harness/pictures.mjs";
import { startServer } from "./harness/server.mjs";

let server;
let browser;
let viewer;

before(async () => {
  server = await startServer();
  browser = await launchBrowser();
  viewer = await openViewer(browser, server.url);
});

after(async () => {
  await browser?.close();
  await server?.stop();
});

async function lookAt(name) {
  return thumbnail(viewer.page, await pictureScreenshot(viewer.page, name));
}

async function eye() {
  return (await server.call("camera.get")).eye;
}

test("the page comes with a content security policy", () => {
  const policy = viewer.response.headers()["content-security-policy"] ?? "";
  assert.match(policy, /default-src 'self'/);
  assert.doesNotMatch(policy, /unsafe/);
});

test("the first picture is the scene that the server captures", async () => {
  const { page } = viewer;
  await firstPicture(page);
  await settle(page);
  const seen = await lookAt("first_picture");
  const { deviation } = statistics(seen);
  assert.ok(deviation > 0.03, `the picture is nearly blank: deviation ${deviation}`);

  const capture = await server.call("frame.capture", { buffer: "output", format: "png" });
  const png = Buffer.from(capture.data, "base64");
  writeFileSync(join(outputFolder, "first_picture_captured.png"), png);
  const distance = difference(seen, await thumbnail(page, png));
  assert.ok(distance < 0.05, `screen and capture differ by ${distance}`);
  await screenshot(page, "first_picture_with_panel");
});

test("the picture has the shape of the window and follows a resize", async () => {
  const { page } = viewer;
  const shape = async () => {
    const [width, height] = (await figure(page, "picture")).split("×").map(Number);
    return width / height;
  };
  assert.ok(Math.abs((await shape()) - 1280 / 720) < 0.02);
  await page.setViewportSize({ width: 900, height: 720 });
  await eventually(async () => Math.abs((await shape()) - 900 / 720) < 0.02, "a resized picture");
  await page.setViewportSize({ width: 1280, height: 720 });
  await eventually(async () => Math.abs((await shape()) - 1280 / 720) < 0.02, "a resized picture");
});

test("dragging orbits and a latency figure appears", async () => {
  const { page } = viewer;
  await settle(page);
  const before = await lookAt("before_orbit");
  const eyeBefore = await eye();
  await dragPicture(page, { x: 300, y: 400 }, { x: 520, y: 440 });
  const changed = await eventually(async () => {
    const distance = difference(before, await lookAt("after_orbit"));
    return distance > 0.01 && distance;
  }, "a changed picture");
  assert.ok(changed > 0.01);
  const eyeAfter = await eye();
  const moved = Math.hypot(...eyeAfter.map((value, axis) => value - eyeBefore[axis]));
  assert.ok(moved > 0.01, "the camera of the session has not moved");
  const latency = await eventually(async () => {
    const text = await figure(page, "latency");
    return /^\d+ ms$/.test(text) && text;
  }, "a latency figure");
  assert.ok(Number.parseFloat(latency) < 30_000, latency);
});

test("wheel, keyboard and right drag move the camera, F fits it", async () => {
  const { page } = viewer;
  const expectMove = async (what, action) => {
    await page.waitForTimeout(400);
    const start = JSON.stringify(await eye());
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

test("timings of the passes are shown", async () => {
  const { page } = viewer;
  const { buffers } = await server.call("frame.buffers");
  assert.equal(buffers[0].name, "output");
  await dragPicture(page, { x: 400, y: 400 }, { x: 430, y: 400 });
  await openTab(page, "stats");
  await page.waitForSelector(".pass", { timeout: 20_000 });
  const rows = await page.locator(".pass .pass-ms").allInnerTexts();
  assert.ok(rows.length >= 3, `only ${rows.length} passes`);
  assert.ok(rows.some((text) => Number(text) > 0));
  assert.match(await figure(page, "frame"), /\d ms$/);
});

test("nothing was written to the console and no policy was violated", () => {
  assert.deepEqual(viewer.complaints, []);
});
