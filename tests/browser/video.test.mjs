// H.264 streams decoded by the browser; motion JPEG where WebSockets do not get through.

import assert from "node:assert/strict";
import { eventually, viewScreenshot, prepareWorker, screenshot } from "./harness/browser.mjs";
import { statistics, thumbnail } from "./harness/images.mjs";
import { Stage } from "./harness/stage.mjs";

const [jpeg, h264] = [1, 16]; // codecs of frames

const stage = new Stage({
  view: { viewport: { width: 800, height: 450 } },
});

/** A page that requests H.264; null, with the test skipped, where it is not supported. */
async function watchVideo(t, prelude = "") {
  const context = await stage.context({ stored: { codec: "h264" } });
  if (prelude) await prepareWorker(context, prelude);
  const viewer = await stage.watch({ context });
  if ((await viewer.page.locator("select[name=codec] option").count()) > 1) return viewer;
  t.skip("server or browser has no H.264");
  return null;
}

stage.test("a playing clip is streamed as H.264, the converged frame as JPEG", async (t) => {
  const viewer = await watchVideo(t);
  if (!viewer) return;
  const { page } = viewer;
  await stage.server.call("animation.play", { clip: "moving_objects_light" });
  const drawn = () => page.evaluate(() => window.seen.drawn);
  await eventually(async () => (await drawn())[h264] >= 4, "four video frames", 60_000);
  const { deviation } = statistics(await thumbnail(page, await viewScreenshot(page, "h264")));
  assert.ok(deviation > 0.03, "the video frame is nearly uniform");
  await stage.server.call("animation.pause");
  const stills = (await drawn())[jpeg] ?? 0;
  await eventually(async () => ((await drawn())[jpeg] ?? 0) > stills, "a JPEG frame", 60_000);
});

const played = (page) => page.evaluate(() => window.seen);

/** Lets the decoder fail at the selected frames. Random data instead would not fail reliably. */
const failingAt = (which) => `
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

stage.test("after a decoding error the video restarts without a message", async (t) => {
  const viewer = await watchVideo(t, failingAt("(number) => number === 4"));
  if (!viewer) return;
  const { page } = viewer;
  await stage.server.call("animation.play", { clip: "moving_objects_light" });
  await eventually(async () => (await played(page)).drawn[h264] >= 6, "the video", 120_000);
  const configured = (await played(page)).sent["stream.configure"];
  assert.ok(configured >= 3, `${configured} requests, without a restart`);
  assert.equal(await page.locator(".toast").count(), 0);
  await stage.server.call("animation.pause");
});

stage.test("repeated decoding errors switch to JPEG, with a message", async (t) => {
  const viewer = await watchVideo(t, failingAt("() => true"));
  if (!viewer) return;
  const { page, context } = viewer;
  await stage.server.call("animation.play", { clip: "moving_objects_light" });
  await page
    .locator(".toast", { hasText: "The stream uses JPEG now" })
    .waitFor({ timeout: 120_000 });
  const before = (await played(page)).drawn[jpeg] ?? 0;
  await eventually(async () => (await played(page)).drawn[jpeg] > before + 4, "JPEGs", 60_000);
  assert.equal(await page.locator("select[name=codec]").inputValue(), "jpeg");
  await page.close();
  // While the clip plays, the first frame is a video frame and fails before the page is live.
  await stage.watch({ context });
  await stage.server.call("animation.pause");
});

stage.test("without WebSocket the page shows motion JPEG", async (t) => {
  const answer = await fetch(new URL("api/v1/sessions/main/stream.mjpg", stage.server.url));
  await answer.body?.cancel();
  if (!answer.ok) {
    t.skip("the server has no motion JPEG");
    return;
  }
  const context = await stage.context();
  // To the page, a proxy that rejects upgrades looks like a URL without a WebSocket.
  await prepareWorker(
    context,
    `self.WebSocket = class extends WebSocket {
      constructor(url, protocol) {
        super(url.replace("/ws", "/nothing"), protocol);
      }
    };`,
  );
  const { page } = await stage.open({ context, expectErrors: true });
  await page.waitForSelector('#pill[data-state="mjpeg_fallback"]', { timeout: 60_000 });
  await eventually(
    () => page.locator("#mjpeg").evaluate((image) => image.naturalWidth > 0),
    "a frame without WebSocket",
    30_000,
  );
  await screenshot(page, "mjpeg_fallback");
});
