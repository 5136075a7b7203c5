// What one takes away: pictures, recordings, links, and the viewer inside another page.

import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { readFileSync, writeFileSync } from "node:fs";
import { createServer } from "node:http";
import { join } from "node:path";
import { after } from "node:test";
import {
  chooseOutput,
  eventually,
  screenshot,
  settle,
} from "./harness/browser.mjs";
import { outputFolder } from "./harness/environment.mjs";
import { difference, statistics, thumbnail } from "./harness/pictures.mjs";
import { Stage } from "./harness/stage.mjs";

const permissions = ["clipboard-read", "clipboard-write"];
const view = { viewport: { width: 720, height: 405 } };
const stage = new Stage({ view });

/** A server of pages of another site: every path gives the same page. */
async function otherSite(html) {
  const server = createServer((_, response) => {
    response.setHeader("content-type", "text/html");
    response.end(html());
  });
  await new Promise((resolve) => server.listen(0, "127.0.0.1", resolve));
  return { origin: `http://127.0.0.1:${server.address().port}`, close: () => server.close() };
}

async function saved(page, entry) {
  const download = page.waitForEvent("download", { timeout: 130_000 });
  await chooseOutput(page, entry);
  const file = await download;
  const path = join(outputFolder, file.suggestedFilename());
  await file.saveAs(path);
  return { name: file.suggestedFilename(), path, bytes: readFileSync(path) };
}

/** The data window of an OpenEXR file: attributes follow the magic number and the version. */
function exrWindow(bytes) {
  assert.equal(bytes.readUInt32LE(0), 20000630, "no OpenEXR file");
  const at = bytes.indexOf("dataWindow\0box2i\0") + "dataWindow\0box2i\0".length + 4;
  const [left, top, right, bottom] = [0, 4, 8, 12].map((offset) => bytes.readInt32LE(at + offset));
  return { width: right - left + 1, height: bottom - top + 1 };
}

stage.test("saved pictures are those that the server captures, as PNG and as EXR", async () => {
  const { page } = await stage.watch();
  await settle(page, stage.server);
  const png = await saved(page, "Save picture as PNG");
  assert.match(png.name, /^shadow_objects\.png$/);
  const capture = await stage.server.call("frame.capture", { buffer: "output", format: "png" });
  const [mine, theirs] = [png.bytes, Buffer.from(capture.data, "base64")];
  const [a, b] = [await thumbnail(page, mine), await thumbnail(page, theirs)];
  assert.ok(difference(a, b) < 0.01, "another picture was saved");
  assert.ok(statistics(a).deviation > 0.03, "the saved picture is nearly blank");
  const exr = await saved(page, "Save picture as EXR");
  assert.match(exr.name, /\.exr$/);
  assert.deepEqual(exrWindow(exr.bytes), { width: capture.width, height: capture.height });
});

stage.test("the copied picture is in the clipboard", async () => {
  const { page } = await stage.watch({ permissions });
  await settle(page, stage.server);
  await chooseOutput(page, "Copy picture");
  await page.locator(".toast", { hasText: "The picture is in the clipboard" }).waitFor();
  const base64 = await page.evaluate(async () => {
    const [item] = await navigator.clipboard.read();
    const bytes = new Uint8Array(await (await item.getType("image/png")).arrayBuffer());
    return btoa(Array.from(bytes, (byte) => String.fromCharCode(byte)).join(""));
  });
  const png = Buffer.from(base64, "base64");
  const capture = await stage.server.call("frame.capture", { buffer: "output", format: "png" });
  assert.deepEqual([png.readUInt32BE(16), png.readUInt32BE(20)], [capture.width, capture.height]);
  const wanted = await thumbnail(page, Buffer.from(capture.data, "base64"));
  assert.ok(difference(await thumbnail(page, png), wanted) < 0.01, "another picture was copied");
});

/** Plays a film in a page of its own; size, frames shown and what the last of them looks like. */
async function playFilm(bytes) {
  const page = await (await stage.context()).newPage();
  await page.goto("about:blank");
  return page.evaluate(async (base64) => {
    const film = document.createElement("video");
    const content = Uint8Array.from(atob(base64), (letter) => letter.charCodeAt(0));
    film.src = URL.createObjectURL(new Blob([content], { type: "video/webm" }));
    film.muted = true;
    const ended = new Promise((resolve, reject) => {
      film.onended = resolve;
      film.onerror = () => reject(new Error(film.error.message));
    });
    const colours = new Set();
    const canvas = new OffscreenCanvas(16, 9);
    const context = canvas.getContext("2d", { willReadFrequently: true });
    const look = () => {
      context.drawImage(film, 0, 0, 16, 9);
      colours.add(context.getImageData(0, 0, 16, 9).data.join());
      film.requestVideoFrameCallback(look);
    };
    film.requestVideoFrameCallback(look);
    await film.play();
    await ended;
    return { width: film.videoWidth, height: film.videoHeight, different: colours.size };
  }, bytes.toString("base64"));
}

stage.test("a recording is a film that plays and moves", async () => {
  const { page } = await stage.watch();
  await stage.server.call("animation.play", { clip: "moving_objects_light" });
  const drawn = () =>
    page.evaluate(() => Object.values(window.seen.drawn).reduce((sum, count) => sum + count, 0));
  await chooseOutput(page, "Record a clip");
  await page.locator(".toast", { hasText: "Recording" }).waitFor();
  const before = await drawn();
  await eventually(async () => (await drawn()) >= before + 12, "twelve pictures", 60_000);
  const { width, height } = await page.evaluate(() => window.seen.frame);
  const { name, path, bytes } = await saved(page, "Stop recording");
  await stage.server.call("animation.pause");
  assert.match(name, /\.webm$/);
  const film = await playFilm(bytes);
  assert.ok(Math.abs(film.width / film.height - width / height) < 0.05, JSON.stringify(film));
  assert.ok(film.different >= 4, `only ${film.different} different pictures`);
  const probe = spawnSync("ffprobe", ["-v", "error", "-count_frames", "-show_streams", path]);
  if (probe.status === null) return; // no ffprobe here
  assert.match(String(probe.stdout), /codec_type=video/, String(probe.stderr));
  const frames = Number(/nb_read_frames=(\d+)/.exec(String(probe.stdout))?.[1]);
  assert.ok(frames >= 6, `${frames} frames`);
});

const [friend, stranger] = await Promise.all([
  otherSite(() => friend.html),
  otherSite(() => friend.html),
]);
after(() => [friend, stranger].forEach((site) => site.close()));
const embedded = new Stage({
  view,
  serverArguments: ["--frame-ancestors", friend.origin],
});

embedded.test("the copied code shows the viewer in a page of a site that may, in no other", async () => {
  const { page } = await embedded.watch({ permissions });
  await chooseOutput(page, "Copy code to embed");
  const code = await eventually(async () => {
    const text = await page.evaluate(() => navigator.clipboard.readText());
    return text.startsWith("<iframe") && text;
  }, "the code in the clipboard");
  writeFileSync(join(outputFolder, "embed.html"), code);
  friend.html = `<!doctype html><title>Another site</title><h1>Ours, in between</h1>${code}`;

  const guest = await (await embedded.context({ viewport: { width: 1000, height: 640 } })).newPage();
  await guest.goto(friend.origin);
  const inside = guest.frameLocator("iframe");
  await inside.locator('#pill[data-state="live"]').waitFor({ timeout: 60_000 });
  await inside.locator("#notice").waitFor({ state: "hidden", timeout: 60_000 });
  await screenshot(guest, "embedded");
  const frame = guest.frames()[1];
  await frame.locator("#view").focus();
  const { eye } = await embedded.server.call("camera.get");
  await guest.keyboard.press("ArrowLeft", { delay: 100 });
  await eventually(
    async () => String((await embedded.server.call("camera.get")).eye) !== String(eye),
    "an orbit from inside the other page",
  );

  const refused = await (await embedded.context()).newPage();
  const violations = [];
  refused.on("console", (message) => violations.push(message.text()));
  await refused.goto(stranger.origin);
  await eventually(
    () => violations.some((text) => text.includes("frame-ancestors")),
    "a refusal by the content security policy",
  );
  assert.equal(await refused.frameLocator("iframe").locator("#view").count(), 0);
});
