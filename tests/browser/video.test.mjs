// Moving pictures as H.264, decoded by the browser; where no WebSocket gets through, as motion JPEG.

import assert from "node:assert/strict";
import {
  eventually,
  pictureScreenshot,
  prepareWorker,
  screenshot,
} from "./harness/browser.mjs";
import { statistics, thumbnail } from "./harness/pictures.mjs";
import { Stage } from "./harness/stage.mjs";

const [jpeg, h264] = [1, 16]; // codecs of frames

const stage = new Stage({
  view: { viewport: { width: 800, height: 450 } },
});

/** A page that asks for video; null, the test being skipped, where there is none to be had. */
async function watchVideo(t, prelude = "") {
  const context = await stage.context();
  if (prelude) await prepareWorker(context, prelude);
  await context.addInitScript(() => localStorage.setItem("heliograph.codec", "h264"));
  const viewer = await stage.watch({ context });
  if ((await viewer.page.locator("select[name=codec] option").count()) > 1) return viewer;
  t.skip("server or browser has no H.264");
  return null;
}

stage.test("a playing clip comes as H.264 and is decoded, the resting picture by itself", async (t) => {
  const viewer = await watchVideo(t);
  if (!viewer) return;
  const { page } = viewer;
  await stage.server.call("animation.play", { clip: "moving_objects_light" });
  const drawn = () => page.evaluate(() => window.seen.drawn);
  await eventually(async () => (await drawn())[h264] >= 4, "four pictures of the video", 60_000);
  const { deviation } = statistics(await thumbnail(page, await pictureScreenshot(page, "h264")));
  assert.ok(deviation > 0.03, "the video's picture is nearly blank");
  await stage.server.call("animation.pause");
  const stills = (await drawn())[jpeg] ?? 0;
  await eventually(async () => ((await drawn())[jpeg] ?? 0) > stills, "a still picture", 60_000);
});

const played = (page) => page.evaluate(() => window.seen);

/** Has the decoder fail as it does where it meets what it cannot decode, at one picture or at all.
 * Noise instead of a picture would not do: what comes of that differs from run to run. */
const breaking = (which) => `
  let chunks = 0;
  self.VideoDecoder = class extends VideoDecoder {
    constructor(callbacks) {
      super(callbacks);
      this.failed = callbacks.error;
    }
    decode(chunk) {
      chunks += 1;
      if (!(${which})(chunks)) return super.decode(chunk);
      this.close();
      queueMicrotask(() => this.failed(new DOMException("Decoding error.", "EncodingError")));
    }
  };
`;

stage.test("after a broken picture the video starts anew at once, without a word", async (t) => {
  const viewer = await watchVideo(t, breaking("(number) => number === 4"));
  if (!viewer) return;
  const { page } = viewer;
  await stage.server.call("animation.play", { clip: "moving_objects_light" });
  await eventually(async () => (await played(page)).drawn[h264] >= 6, "the video", 120_000);
  const configured = (await played(page)).sent["stream.configure"];
  assert.ok(configured >= 3, `asked ${configured} times, not for a fresh start`);
  assert.equal(await page.locator(".toast").count(), 0);
  await stage.server.call("animation.pause");
});

stage.test("a video that keeps breaking gives way to single pictures, with a word", async (t) => {
  const viewer = await watchVideo(t, breaking("() => true"));
  if (!viewer) return;
  const { page, context } = viewer;
  await stage.server.call("animation.play", { clip: "moving_objects_light" });
  await page.locator(".toast", { hasText: "single pictures come instead" }).waitFor({ timeout: 120_000 });
  const before = (await played(page)).drawn[jpeg] ?? 0;
  await eventually(async () => (await played(page)).drawn[jpeg] > before + 4, "JPEGs", 60_000);
  assert.equal(await page.locator("select[name=codec]").inputValue(), "jpeg");
  await page.close();
  // While the clip plays the first picture is of the video, and breaks before the page is live.
  await stage.watch({ context });
  await stage.server.call("animation.pause");
});

stage.test("where no WebSocket gets through, the pictures still come", async (t) => {
  const answer = await fetch(new URL("api/v1/sessions/main/stream.mjpg", stage.server.url));
  await answer.body?.cancel();
  if (!answer.ok) {
    t.skip("the server has no motion JPEG");
    return;
  }
  const context = await stage.context();
  // A proxy that refuses upgrades looks to the page like an address where nobody speaks WebSocket.
  await prepareWorker(
    context,
    `self.WebSocket = class extends WebSocket {
      constructor(url, protocol) {
        super(url.replace("/ws", "/nothing"), protocol);
      }
    };`,
  );
  const { page } = await stage.open({ context, complaining: true });
  await page.waitForSelector('#pill[data-state="mjpeg_fallback"]', { timeout: 60_000 });
  await eventually(
    () => page.locator("#plain").evaluate((image) => image.naturalWidth > 0),
    "a picture without WebSocket",
    30_000,
  );
  await screenshot(page, "mjpeg_fallback");
});
