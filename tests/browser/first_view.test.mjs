// The first view of a model without cameras and lights: in the studio, with a shadow under it, beside
// the panel.

import assert from "node:assert/strict";
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after } from "node:test";
import { eventually, screenshot, settle } from "./harness/browser.mjs";
import { sceneRoot } from "./harness/environment.mjs";
import { Stage } from "./harness/stage.mjs";

const folder = mkdtempSync(join(tmpdir(), "heliograph-first-view-"));
after(() => rmSync(folder, { recursive: true, force: true }));
writeFileSync(join(folder, "bare.glb"), withoutCameras(readFileSync(join(sceneRoot, "furnace.glb"))));

const stage = new Stage({ scene: "bare", serverArguments: ["--scene-root", folder] });

/** A binary glTF file whose nodes have no cameras. */
function withoutCameras(file) {
  const end = 20 + file.readUInt32LE(12);
  const document = JSON.parse(file.subarray(20, end).toString());
  delete document.cameras;
  for (const node of document.nodes) delete node.camera;
  const text = JSON.stringify(document);
  const json = Buffer.from(text.padEnd(Math.ceil(text.length / 4) * 4));
  const header = Buffer.from(file.subarray(0, 20));
  header.writeUInt32LE(20 + json.length + file.length - end, 8);
  header.writeUInt32LE(json.length, 12);
  return Buffer.concat([header, json, file.subarray(end)]);
}

/** Mean of the green channel of the image. */
async function brightness(page) {
  const { data } = await stage.server.call("frame.capture", { samples: 8 });
  return page.evaluate(async (base64) => {
    const bytes = Uint8Array.from(atob(base64), (letter) => letter.charCodeAt(0));
    const bitmap = await createImageBitmap(new Blob([bytes], { type: "image/png" }));
    const { width, height } = bitmap;
    const context = new OffscreenCanvas(width, height).getContext("2d");
    context.drawImage(bitmap, 0, 0);
    const { data: texels } = context.getImageData(0, 0, width, height);
    return texels.filter((_, index) => index % 4 === 1).reduce((sum, value) => sum + value, 0) /
      (width * height);
  }, data);
}

stage.test("a bare model opens beside the panel, and stays where the user has moved it", async () => {
  const { page } = await stage.watch();
  const camera = await eventually(async () => {
    const found = await stage.server.call("camera.get");
    return !found.fitted && found;
  }, "the page to move the camera aside");
  await settle(page, stage.server);
  await screenshot(page, "first_view");
  const panel = await page.locator("#panel").boundingBox();
  const { width } = page.viewportSize();
  const at = async (x) => (await stage.server.call("scene.pick", { x, y: 0.55 })).hit;
  assert.equal(await at(panel.x / 2 / width), true, "nothing is in the middle of the free part");
  assert.equal(await at((panel.x + panel.width / 2) / width), false, "the model is under the panel");
  const second = await stage.watch();
  await settle(second.page, stage.server);
  assert.deepEqual(await stage.server.call("camera.get"), camera, "another page has moved it");
});

stage.test("the studio alone has shadows on the ground and adapts exposure", async () => {
  const { page } = await stage.watch();
  const patch = (settings) => stage.server.call("settings.patch", { patch: settings });
  await patch({ exposure: { mode: "manual" } });
  const shaded = await brightness(page);
  await patch({ background: { ground: "off" } });
  const open = await brightness(page);
  assert.ok(shaded < open - 1, `${shaded}, ${open} without ground`);
  await patch({ background: null, environment: { intensity: 0.3 } });
  const dark = await brightness(page);
  await patch({ exposure: null });
  await eventually(async () => (await brightness(page)) > 1.2 * dark, "exposure to adapt");
  await patch({ environment: null });
});
