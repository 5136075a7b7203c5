// Leaks and main thread load over many frames. Takes longer than the other tests; run by
// `ctest -C long -R browser_endurance`.

import assert from "node:assert/strict";
import { eventually, prepareWorker } from "../harness/browser.mjs";
import { Stage } from "../harness/stage.mjs";

const frames = 500;
const maxGrowth = 4e6; // bytes
const maxOpenFrames = 4;
const maxBusy = 0.2; // of the main thread's time

const stage = new Stage({
  view: { viewport: { width: 320, height: 180 } },
});

/** Runs in the stream worker before its own script: counts frames that were decoded and closed. */
const counting = `
  self.frameCounts = { decoded: 0, closed: 0 };
  const decode = ImageDecoder.prototype.decode;
  ImageDecoder.prototype.decode = async function (...options) {
    const result = await decode.apply(this, options);
    self.frameCounts.decoded += 1;
    return result;
  };
  const close = VideoFrame.prototype.close;
  VideoFrame.prototype.close = function () {
    self.frameCounts.closed += 1;
    close.call(this);
  };
`;

stage.test(
  `${frames} frames leak no frames and no heap, and the main thread is mostly idle`,
  async () => {
    const context = await stage.context();
    await prepareWorker(context, counting);
    const { page } = await stage.watch({ context });
    const worker = page.workers()[0];
    const counts = () => worker.evaluate(() => self.frameCounts);
    const session = await context.newCDPSession(page);
    await session.send("Performance.enable");
    const usedHeap = async () => {
      await session.send("HeapProfiler.collectGarbage");
      return (await session.send("Runtime.getHeapUsage")).usedSize;
    };
    const busySeconds = async () => {
      const { metrics } = await session.send("Performance.getMetrics");
      return metrics.find(({ name }) => name === "TaskDuration").value;
    };
    await stage.server.call("animation.play", { clip: "moving_objects_light" });
    await eventually(async () => (await counts()).decoded > 40, "forty frames", 120_000);

    const [heapBefore, busyBefore, startedAt] = [await usedHeap(), await busySeconds(), Date.now()];
    const { decoded } = await counts();
    await eventually(
      async () => (await counts()).decoded > decoded + frames,
      "the frames",
      480_000,
    );
    const busy = ((await busySeconds()) - busyBefore) / ((Date.now() - startedAt) / 1000);
    const growth = (await usedHeap()) - heapBefore;
    const after = await counts();
    console.log(JSON.stringify({ frames, growth, busy, alive: after.decoded - after.closed }));
    assert.ok(growth < maxGrowth, `the heap grew by ${growth} bytes`);
    assert.ok(after.decoded - after.closed <= maxOpenFrames, JSON.stringify(after));
    assert.ok(busy < maxBusy, `the main thread is busy ${(busy * 100).toFixed(0)} % of the time`);
  },
);
