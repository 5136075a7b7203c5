// The client in Firefox: it connects, draws the scene, follows the keyboard and shows every tab
// without browser errors. Skipped with a message where Firefox is not installed (HELIOGRAPH_FIREFOX
// sets its path).

import assert from "node:assert/strict";
import { existsSync } from "node:fs";
import { join } from "node:path";
import { eventually } from "../harness/browser.mjs";
import { outputFolder } from "../harness/environment.mjs";
import { Firefox } from "../harness/marionette.mjs";
import { Stage } from "../harness/stage.mjs";

const path =
  process.env.HELIOGRAPH_FIREFOX ??
  ["/usr/bin/firefox-esr", "/usr/bin/firefox"].find((one) => existsSync(one));
const stage = new Stage();

/** Mean and deviation of the canvas, sampled on a coarse grid. */
const frameStatistics = `
  const canvas = document.createElement("canvas");
  [canvas.width, canvas.height] = [48, 27];
  const context = canvas.getContext("2d");
  context.drawImage(document.querySelector("#view"), 0, 0, 48, 27);
  const values = context.getImageData(0, 0, 48, 27).data.filter((_, index) => index % 4 !== 3);
  const mean = values.reduce((sum, value) => sum + value, 0) / values.length;
  const variance = values.reduce((sum, value) => sum + (value - mean) ** 2, 0) / values.length;
  return { mean: mean / 255, deviation: Math.sqrt(variance) / 255 };
`;

stage.test("Firefox connects, draws the scene and moves the camera", async (t) => {
  if (!path) {
    t.skip("Firefox is not installed");
    return;
  }
  const firefox = await Firefox.launch(path);
  try {
    await firefox.open(stage.server.url);
    await eventually(
      () => firefox.evaluate(`return document.querySelector("#pill").dataset.state === "live"`),
      "a connection",
      60_000,
    );
    await eventually(
      () => firefox.evaluate(`return document.querySelector("#notice").hidden`),
      "a frame",
      60_000,
    );
    const { deviation } = await firefox.evaluate(frameStatistics);
    assert.ok(deviation > 0.03, `the frame is nearly uniform: ${deviation}`);
    const rows = await firefox.evaluate(`return document.querySelectorAll("[data-path]").length`);
    assert.ok(rows > 50, `only ${rows} settings`);
    const { eye } = await stage.server.call("camera.get");
    await firefox.evaluate(`
      const view = document.querySelector("#view");
      view.focus();
      const key = { key: "ArrowLeft", code: "ArrowLeft", bubbles: true };
      view.dispatchEvent(new KeyboardEvent("keydown", key));
      setTimeout(() => view.dispatchEvent(new KeyboardEvent("keyup", key)), 100);
    `);
    await eventually(
      async () => String((await stage.server.call("camera.get")).eye) !== String(eye),
      "an orbit",
    );
    for (const tab of ["settings", "inspect", "timing", "scene"]) {
      await firefox.evaluate(`document.querySelector("#tab-" + arguments[0]).click()`, tab);
      await firefox.screenshot(join(outputFolder, `firefox_${tab}.png`));
    }
    const codecs = await firefox.evaluate(`
      return [...document.querySelectorAll("select[name=codec] option")].map(({ value }) => value);
    `);
    console.log(await firefox.evaluate("return navigator.userAgent"), codecs.join());
    assert.deepEqual(await firefox.pageErrors(stage.server.url), []);
  } finally {
    await firefox.close();
  }
});
