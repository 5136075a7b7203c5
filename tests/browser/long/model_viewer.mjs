// The first view of ten models beside that of <model-viewer>, both with their defaults, as one sheet
// to look at (default_views.png). Measures what can be: the middle of the view is neither dark nor
// burnt. Skipped where the assets or the package @google/model-viewer are missing (NODE_PATH names the
// folder where `npm install @google/model-viewer three` has put them).

import assert from "node:assert/strict";
import { existsSync, readFileSync, writeFileSync } from "node:fs";
import { createServer } from "node:http";
import { createRequire } from "node:module";
import { dirname, join } from "node:path";
import { test } from "node:test";
import { chromium } from "playwright-core";
import { chromiumPath, outputFolder } from "../harness/environment.mjs";
import { startServer } from "../harness/server.mjs";

const size = { width: 480, height: 360 };
const models = [
  "DamagedHelmet.glb",
  "FlightHelmet/FlightHelmet.gltf",
  "Duck.glb",
  "Fox.glb",
  "CesiumMan.glb",
  "SpecularTest.glb",
  "NormalTangentTest.glb",
  "statue.glb",
  "house.glb",
  "BoxAnimated.glb",
];

const assets = process.env.HELIOGRAPH_TEST_ASSETS;
const folder = assets ? join(assets, "gltf") : "";

function packageFile() {
  try {
    const main = createRequire(import.meta.url).resolve("@google/model-viewer");
    return join(dirname(main), "model-viewer.min.js");
  } catch {
    return null;
  }
}

const page = (model) => `<!doctype html>
<style>body { margin: 0 } model-viewer { width: ${size.width}px; height: ${size.height}px }</style>
<script type="module" src="/model-viewer.js"></script>
<model-viewer src="/models/${model}" interaction-prompt="none"></model-viewer>`;

/** Serves the element and the models. */
function serve(script) {
  const server = createServer((request, response) => {
    const path = decodeURIComponent(new URL(request.url, "http://localhost").pathname);
    const file = path.startsWith("/models/") ? join(folder, path.slice("/models/".length)) : null;
    if (path === "/model-viewer.js") {
      response.setHeader("content-type", "text/javascript");
      response.end(readFileSync(script));
    } else if (file && existsSync(file)) {
      response.end(readFileSync(file));
    } else if (path.startsWith("/show/")) {
      response.setHeader("content-type", "text/html");
      response.end(page(path.slice("/show/".length)));
    } else {
      response.statusCode = 404;
      response.end();
    }
  });
  return new Promise((resolve) => server.listen(0, "127.0.0.1", () => resolve(server)));
}

/** The light in the middle of an image, and how much of it is white. */
const measure = async (source) => {
  const image = new Image();
  image.src = source;
  await image.decode();
  const { width, height } = image;
  const context = new OffscreenCanvas(width, height).getContext("2d");
  context.drawImage(image, 0, 0);
  const { data } = context.getImageData(0, 0, width, height);
  const middle = [];
  for (let y = Math.round(0.3 * height); y < 0.7 * height; y += 1) {
    for (let x = Math.round(0.38 * width); x < 0.62 * width; x += 1) {
      const at = 4 * (y * width + x);
      middle.push(0.2126 * data[at] + 0.7152 * data[at + 1] + 0.0722 * data[at + 2]);
    }
  }
  const mean = middle.reduce((sum, value) => sum + value, 0) / middle.length;
  const burnt = middle.filter((value) => value > 252).length / middle.length;
  return { mean, burnt };
};

test("first views stand beside those of model-viewer", async (t) => {
  const script = packageFile();
  if (!script) return t.skip("@google/model-viewer is not installed");
  if (!folder || !existsSync(join(folder, models[0]))) return t.skip("no assets");
  const [theirs, ours] = await Promise.all([
    serve(script),
    startServer(0, ["--scene-root", folder]),
  ]);
  const browser = await chromium.launch({
    executablePath: chromiumPath,
    args: ["--headless", "--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"],
  });
  try {
    const view = await browser.newPage({ viewport: size });
    const rows = [];
    for (const model of models) {
      await view.goto(`http://127.0.0.1:${theirs.address().port}/show/${model}`);
      await view.waitForFunction(() => document.querySelector("model-viewer").loaded, undefined, {
        timeout: 60_000,
      });
      await view.waitForTimeout(1500);
      const their = `data:image/png;base64,${(await view.screenshot()).toString("base64")}`;
      await ours.call("scene.load", { name: model.replace(/\.gl(b|tf)$/, "") });
      const address = `api/v1/sessions/main/frame.png?width=${size.width}&height=${size.height}&fit=1&samples=64`;
      const answer = await fetch(new URL(address, ours.url));
      assert.equal(answer.status, 200, `${model}: ${answer.status}`);
      const bytes = Buffer.from(await answer.arrayBuffer());
      rows.push({ model, their, our: `data:image/png;base64,${bytes.toString("base64")}` });
    }
    const sheet = await browser.newPage({ viewport: { width: 2 * size.width, height: 600 } });
    await sheet.setContent(
      `<style>body { margin: 0; display: grid; grid-template-columns: 1fr 1fr; font: 14px sans-serif }
       figure { margin: 0; position: relative } figcaption { position: absolute; left: 6px; top: 4px }
       </style>` +
        rows
          .map(
            ({ model, their, our }) =>
              `<figure><img src="${our}"><figcaption>${model}, ours</figcaption></figure>` +
              `<figure><img src="${their}"><figcaption>model-viewer</figcaption></figure>`,
          )
          .join(""),
    );
    await sheet.screenshot({ path: join(outputFolder, "default_views.png"), fullPage: true });
    const results = [];
    for (const { model, their, our } of rows) {
      const [we, they] = [await sheet.evaluate(measure, our), await sheet.evaluate(measure, their)];
      results.push({ model, we, they });
      t.diagnostic(
        `${model}: mean ${we.mean.toFixed(0)} (${they.mean.toFixed(0)}), ` +
          `burnt ${(100 * we.burnt).toFixed(1)} % (${(100 * they.burnt).toFixed(1)} %)`,
      );
    }
    writeFileSync(join(outputFolder, "default_views.json"), JSON.stringify(results, null, 1));
    for (const { model, we } of results) {
      assert.ok(we.mean > 55 && we.mean < 205, `the light of ${model}: ${we.mean} of 255`);
      assert.ok(we.burnt < 0.02, `${model} is too bright: ${we.burnt}`);
    }
  } finally {
    await browser.close();
    theirs.close();
    await ours.stop();
  }
});
