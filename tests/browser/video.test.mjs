// Moving pictures as H.264, decoded by the browser; where no WebSocket gets through, as motion JPEG.

import assert from "node:assert/strict";
import test, { after, before } from "node:test";
import {
  eventually,
  firstPicture,
  launchBrowser,
  openViewer,
  pictureScreenshot,
  prepareWorker,
  screenshot,
} from "./harness/browser.mjs";
import { statistics, thumbnail } from "./harness/pictures.mjs";
import { startServer } from "./harness/server.mjs";

let server;
let browser;

before(async () => {
  server = await startServer();
  await server.call("scene.load", { name: "shadow_objects" });
  browser = await launchBrowser();
});

after(async () => {
  await browser?.close();
  await server?.stop();
});

/** Counts, in the page, drawn frames by their codec. */
function countCodecs() {
  localStorage.setItem("heliograph.codec", "h264");
  window.drawn = {};
  const handler = Object.getOwnPropertyDescriptor(Worker.prototype, "onmessage");
  Object.defineProperty(Worker.prototype, "onmessage", {
    set(listener) {
      handler.set.call(this, (event) => {
        const { kind, frame } = event.data;
        if (kind === "drawn") window.drawn[frame.codec] = (window.drawn[frame.codec] ?? 0) + 1;
        listener(event);
      });
    },
  });
}

test("a playing clip comes as H.264 and is decoded, the resting picture by itself", async (t) => {
  const context = await browser.newContext({ viewport: { width: 800, height: 450 } });
  await context.addInitScript(countCodecs);
  const { page, complaints } = await openViewer(browser, server.url, { context });
  await firstPicture(page);
  const choices = await page.locator("select[name=codec] option").count();
  if (choices < 2) {
    await context.close();
    t.skip("server or browser has no H.264");
    return;
  }
  await server.call("animation.play", { clip: "moving_objects_light" });
  const drawn = () => page.evaluate(() => window.drawn);
  await eventually(async () => (await drawn())[16] >= 4, "four pictures of the video", 60_000);
  const { deviation } = statistics(await thumbnail(page, await pictureScreenshot(page, "h264")));
  assert.ok(deviation > 0.03, "the video's picture is nearly blank");
  await server.call("animation.pause");
  const stills = (await drawn())[1] ?? 0;
  await eventually(async () => ((await drawn())[1] ?? 0) > stills, "a still picture", 60_000);
  assert.deepEqual(complaints, []);
  await context.close();
});

test("where no WebSocket gets through, the pictures still come", async (t) => {
  const answer = await fetch(new URL("api/v1/sessions/main/stream.mjpg", server.url));
  await answer.body?.cancel();
  if (!answer.ok) {
    t.skip("the server has no motion JPEG");
    return;
  }
  const context = await browser.newContext({ viewport: { width: 800, height: 450 } });
  // A proxy that refuses upgrades looks to the page like an address where nobody speaks WebSocket.
  await prepareWorker(
    context,
    `self.WebSocket = class extends WebSocket {
      constructor(url, protocol) {
        super(url.replace("/ws", "/nothing"), protocol);
      }
    };`,
  );
  const { page } = await openViewer(browser, server.url, { context });
  await page.waitForSelector('#pill[data-state="pictures_only"]', { timeout: 60_000 });
  await eventually(
    () => page.locator("#plain").evaluate((image) => image.naturalWidth > 0),
    "a picture without WebSocket",
    30_000,
  );
  await screenshot(page, "pictures_only");
  await context.close();
});
