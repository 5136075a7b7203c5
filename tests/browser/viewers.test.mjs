// Several viewers, small screens, and a server that goes away and comes back.

import assert from "node:assert/strict";
import test, { after, before } from "node:test";
import {
  distance,
  dragPicture,
  eventually,
  firstPicture,
  launchBrowser,
  openViewer,
  pictureScreenshot,
  screenshot,
  settle,
} from "./harness/browser.mjs";
import { difference, statistics, thumbnail } from "./harness/pictures.mjs";
import { startServer } from "./harness/server.mjs";

let server;
let browser;

before(async () => {
  server = await startServer();
  browser = await launchBrowser();
});

after(async () => {
  await browser?.close();
  await server?.stop();
});

async function lookAt(page, name) {
  return thumbnail(page, await pictureScreenshot(page, name));
}

test("a second viewer joins and sees what the first one does", async () => {
  const first = await openViewer(browser, server.url);
  await firstPicture(first.page);
  const second = await openViewer(browser, server.url);
  await firstPicture(second.page);
  await settle(second.page);
  const before = await lookAt(second.page, "second_viewer_before");
  assert.ok(statistics(before).deviation > 0.03, "the second viewer's picture is nearly blank");
  await dragPicture(first.page, { x: 300, y: 300 }, { x: 560, y: 330 });
  await eventually(
    async () => difference(before, await lookAt(second.page, "second_viewer_after")) > 0.01,
    "a changed picture at the second viewer",
  );
  await first.context.close();
  await settle(second.page);
  const alone = await lookAt(second.page, "second_viewer_alone");
  await dragPicture(second.page, { x: 560, y: 330 }, { x: 300, y: 300 });
  await eventually(
    async () => difference(alone, await lookAt(second.page, "second_viewer_moved")) > 0.01,
    "the second viewer to go on alone",
  );
  assert.deepEqual([...first.complaints, ...second.complaints], []);
  await second.context.close();
});

/** One finger from one point to another, as the browser hears it from a touch screen. */
async function swipe(page, from, to) {
  const session = await page.context().newCDPSession(page);
  const touch = (type, point) =>
    session.send("Input.dispatchTouchEvent", { type, touchPoints: point ? [point] : [] });
  await touch("touchStart", from);
  for (let step = 1; step <= 8; step += 1) {
    const part = step / 8;
    await touch("touchMove", {
      x: from.x + (to.x - from.x) * part,
      y: from.y + (to.y - from.y) * part,
    });
    await page.waitForTimeout(20);
  }
  await touch("touchEnd");
}

/** Two fingers that part while both move to the right. */
async function pinch(page, middle) {
  const session = await page.context().newCDPSession(page);
  const points = (step) => [
    { x: middle.x - 30 - step * 3, y: middle.y, id: 0 },
    { x: middle.x + 30 + step * 9, y: middle.y, id: 1 },
  ];
  await session.send("Input.dispatchTouchEvent", { type: "touchStart", touchPoints: points(0) });
  for (let step = 1; step <= 8; step += 1) {
    await session.send("Input.dispatchTouchEvent", { type: "touchMove", touchPoints: points(step) });
    await page.waitForTimeout(20);
  }
  await session.send("Input.dispatchTouchEvent", { type: "touchEnd", touchPoints: [] });
}

test("on a phone the panel is a sheet and a finger orbits", async () => {
  const { page, context, complaints } = await openViewer(browser, server.url, {
    viewport: { width: 360, height: 740 },
    deviceScaleFactor: 2,
    hasTouch: true,
    isMobile: true,
  });
  await firstPicture(page);
  await settle(page);
  await screenshot(page, "phone");
  const panel = page.locator("#panel");
  const folded = await panel.boundingBox();
  assert.ok(folded.y > 600, "the sheet covers the picture at first");

  const eyeBefore = JSON.stringify((await server.call("camera.get")).eye);
  await swipe(page, { x: 120, y: 300 }, { x: 260, y: 320 });
  await eventually(
    async () => JSON.stringify((await server.call("camera.get")).eye) !== eyeBefore,
    "an orbit by finger",
  );
  await page.waitForTimeout(1000);
  const apart = await server.call("camera.get");
  await pinch(page, { x: 180, y: 300 });
  await eventually(async () => {
    const { eye, target } = await server.call("camera.get");
    const closer = distance(eye, target) < 0.9 * distance(apart.eye, apart.target);
    return closer && distance(target, apart.target) > 0;
  }, "a pinch to move closer and aside");

  await page.getByRole("button", { name: "Show panel" }).tap();
  await eventually(async () => (await panel.boundingBox()).y < 500, "an open sheet");
  await page.evaluate(() => {
    for (const fold of document.querySelectorAll(".section details")) fold.open = true;
  });
  await screenshot(page, "phone_sheet");
  const widest = await page.evaluate(() =>
    Math.max(
      document.documentElement.scrollWidth,
      ...[...document.querySelectorAll("#panel *")].map((node) => {
        const box = node.getBoundingClientRect();
        return box.width > 0 ? box.right : 0;
      }),
    ),
  );
  assert.ok(widest <= 360, `something reaches to ${widest} px`);
  assert.deepEqual(complaints, []);
  await context.close();
});

test("where a canvas cannot be handed to the worker the page draws itself", async () => {
  const context = await browser.newContext();
  await context.addInitScript(() => {
    delete HTMLCanvasElement.prototype.transferControlToOffscreen;
  });
  const { page, complaints } = await openViewer(browser, server.url, { context });
  await firstPicture(page);
  await settle(page);
  const { deviation } = statistics(await lookAt(page, "drawn_by_page"));
  assert.ok(deviation > 0.03, "the picture is nearly blank");
  assert.deepEqual(complaints, []);
  await context.close();
});

test("after a restart of the server the page brings scene, settings and camera back", async () => {
  const { page, context, complaints } = await openViewer(browser, server.url);
  await firstPicture(page);
  const { scenes, current } = await server.call("scene.list");
  const scene = scenes.find(({ name }) => name.includes("shadow_objects")).name;
  assert.notEqual(current, scene);
  await server.call("scene.load", { name: scene });
  await server.call("settings.patch", { patch: { exposure: { compensation: 0.75 } } });
  await page.waitForFunction((name) => document.title.startsWith(name), scene);
  await dragPicture(page, { x: 300, y: 300 }, { x: 520, y: 360 });
  // The drag runs on a little after it ends: the camera to come back to is the one at rest.
  let eyeBefore = null;
  await eventually(async () => {
    const seen = (await server.call("camera.get")).eye;
    const rests = eyeBefore !== null && distance(seen, eyeBefore) === 0;
    eyeBefore = seen;
    await page.waitForTimeout(500);
    return rests;
  }, "the camera to rest");
  assert.deepEqual(complaints, []);

  const { port } = server;
  await server.stop();
  await page.waitForSelector('#pill[data-state="lost"]', { timeout: 20_000 });
  await page.getByText("Connection lost").waitFor();
  await screenshot(page, "connection_lost");
  server = await startServer(port);
  await page.waitForSelector('#pill[data-state="live"]', { timeout: 40_000 });
  await eventually(async () => {
    const camera = await server.call("camera.get").catch(() => null); // no scene at first
    return camera && distance(camera.eye, eyeBefore) < 1e-3;
  }, "the camera to be restored");
  assert.equal((await server.call("scene.list")).current, scene);
  assert.equal(await server.setting("exposure.compensation"), 0.75);
  await firstPicture(page);
  await settle(page);
  await screenshot(page, "connection_back");
  assert.ok(statistics(await lookAt(page, "after_restart")).deviation > 0.03);
  await context.close();
});
