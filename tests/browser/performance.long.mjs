// How fast the client is: from the address to the first picture, from a picture's bytes to the
// screen, and how much of the main thread thirty pictures a second take.

import assert from "node:assert/strict";
import { appendFileSync } from "node:fs";
import { join } from "node:path";
import { eventually } from "./harness/browser.mjs";
import { outputFolder } from "./harness/environment.mjs";
import { Stage } from "./harness/stage.mjs";

const longestLoad = 500; // ms
const oneFrame = 1000 / 30; // ms
const busiest = 0.2; // of the main thread's time
const watchedPictures = 100;
const longestWatchMs = 60_000;
/** Where fewer pictures come in a second, what goes on without any outweighs them. */
const telling = 5;

/** The cheapest picture there is: what is measured here is the client, not the renderer. */
const everythingOff = {
  shadows: { enabled: false },
  specular: { enabled: false },
  ambient: { occlusion: false },
  antialiasing: { temporal: false },
  motion: { scale: 1 },
};

const stage = new Stage({
  view: { viewport: { width: 1280, height: 720 } },
});

function report(name, figures) {
  const line = JSON.stringify({ name, ...figures });
  console.log(line);
  appendFileSync(join(outputFolder, "performance.jsonl"), `${line}\n`);
}

const median = (values) => [...values].sort((a, b) => a - b)[values.length >> 1];

stage.test("the page is there, live and shows its first picture", async () => {
  const context = await stage.context();
  await context.addInitScript(() => {
    window.moments = {};
    new MutationObserver(() => {
      const live = document.querySelector('#pill[data-state="live"]');
      if (live) window.moments.live ??= performance.now();
    }).observe(document, { subtree: true, childList: true, attributes: true });
  });
  const seen = [];
  for (let visit = 0; visit < 5; visit += 1) {
    const { page } = await stage.watch({ context });
    seen.push(
      await page.evaluate(() => {
        const [{ loadEventEnd, domContentLoadedEventEnd }] =
          performance.getEntriesByType("navigation");
        const { live } = window.moments;
        const drawn = window.seen.firstDrawnAt - performance.timeOrigin;
        return { ready: domContentLoadedEventEnd, loaded: loadEventEnd, live, drawn };
      }),
    );
    await page.close();
  }
  const of = (moment) => Math.round(median(seen.map((one) => one[moment])));
  const figures = { ready: of("ready"), loaded: of("loaded"), live: of("live"), drawn: of("drawn") };
  report("loading_ms", figures);
  assert.ok(figures.loaded < longestLoad, `loaded after ${figures.loaded} ms`);
});

/** Streams a clip to a page of 1280 x 720 and tells what that took. */
async function stream(resolution) {
  const context = await stage.context();
  await context.addInitScript(
    (choice) => localStorage.setItem("heliograph.resolution", choice),
    resolution,
  );
  const { page } = await stage.watch({ context });
  const session = await context.newCDPSession(page);
  // The thread's own clock: what other processes take of the machine does not count.
  await session.send("Performance.enable", { timeDomain: "threadTicks" });
  const busySeconds = async () => {
    const { metrics } = await session.send("Performance.getMetrics");
    return metrics.find(({ name }) => name === "TaskDuration").value;
  };
  await stage.server.call("animation.play", { clip: "moving_objects_light" });
  const drawn = () => page.evaluate(() => window.seen.drawn[1] ?? 0);
  const first = await drawn();
  await eventually(async () => (await drawn()) > first + 5, "moving pictures", 180_000);
  const [busyBefore, drawnBefore, startedAt] = [await busySeconds(), await drawn(), Date.now()];
  const soFar = async () => (await drawn()) - drawnBefore;
  while ((await soFar()) < watchedPictures && Date.now() - startedAt < longestWatchMs) {
    await page.waitForTimeout(1000);
  }
  const [pictures, busy] = [await soFar(), (await busySeconds()) - busyBefore];
  const seconds = (Date.now() - startedAt) / 1000;
  const { delays, frame } = await page.evaluate(() => window.seen);
  await stage.server.call("animation.pause");
  await context.close();
  const figures = {
    size: `${frame.width}x${frame.height}`,
    fps: Number((pictures / seconds).toFixed(1)),
    busy: Number((busy / seconds).toFixed(4)),
    // An upper bound: what goes on without any picture is counted with each of them.
    busyAtThirty: Number(((busy / pictures) * 30).toFixed(4)),
    toScreenMs: Number(median(delays).toFixed(2)),
  };
  report("streaming", figures);
  return figures;
}

stage.test("each picture of 1280 x 720 is on the screen soon", async () => {
  await stage.server.call("settings.patch", { patch: everythingOff });
  const figures = await stream("full");
  assert.equal(figures.size, "1280x720");
  assert.ok(figures.toScreenMs < oneFrame, JSON.stringify(figures));
});

// The main thread never touches a pixel: pictures of a third the size show what it does for each,
// and come as fast as they should on a machine that renders in software.
stage.test("thirty pictures a second leave the main thread free", async (t) => {
  await stage.server.call("settings.patch", { patch: everythingOff });
  const figures = await stream("third");
  if (figures.fps < telling) {
    t.skip(`only ${figures.fps} pictures a second: something else keeps this machine busy`);
    return;
  }
  assert.ok(figures.busyAtThirty < busiest, JSON.stringify(figures));
});
