// Images per second that a user sees while orbiting an atrium, with and without reprojection, beside
// the frames that the server renders.

import assert from "node:assert/strict";
import { appendFileSync } from "node:fs";
import { join } from "node:path";
import { figure, openTab, settle, viewScreenshot } from "../harness/browser.mjs";
import { outputFolder } from "../harness/environment.mjs";
import { Stage } from "../harness/stage.mjs";

const orbitMs = 8000;
const stage = new Stage({
  scene: "glossy_sponza_1",
  samples: 16,
  resolution: "half",
  view: { viewport: { width: 1280, height: 720 } },
});

/** Moves the pointer in a circle with the button pressed, once per frame of the screen. */
async function orbit(page, name) {
  const at = (ms) => [640 + 60 * Math.sin(ms / 900), 380 + 15 * Math.sin(ms / 700)];
  await page.mouse.move(...at(0));
  await page.mouse.down();
  const start = Date.now();
  const before = await page.evaluate(() => ({ ...window.seen, at: performance.now() }));
  while (Date.now() - start < orbitMs) {
    await page.mouse.move(...at(Date.now() - start));
    await page.evaluate(() => new Promise((drawn) => requestAnimationFrame(drawn)));
  }
  const after = await page.evaluate(() => ({ ...window.seen, at: performance.now() }));
  await viewScreenshot(page, `orbiting_${name}`);
  await page.mouse.up();
  const seconds = (after.at - before.at) / 1000;
  const all = ({ drawn }) => Object.values(drawn).reduce((sum, count) => sum + count, 0);
  return {
    shown: Number(((after.shown - before.shown) / seconds).toFixed(1)),
    frames: Number(((all(after) - all(before)) / seconds).toFixed(1)),
    response: await figure(page, "response"),
    latency: await figure(page, "latency"),
  };
}

stage.test("orbiting shows more images than the server renders", async () => {
  const results = {};
  for (const reprojection of [false, true]) {
    const context = await stage.context({ stored: { reprojection: reprojection ? "1" : "0" } });
    const { page } = await stage.watch({ context });
    await openTab(page, "timing");
    await settle(page, stage.server);
    results[reprojection ? "with" : "without"] = await orbit(page, reprojection ? "with" : "without");
    await context.close();
  }
  const line = JSON.stringify({ name: "orbiting", ...results });
  console.log(line);
  appendFileSync(join(outputFolder, "performance.jsonl"), `${line}\n`);
  assert.ok(results.with.shown > 2 * results.with.frames, line);
  assert.ok(results.without.shown <= 1.1 * results.without.frames, line);
});
