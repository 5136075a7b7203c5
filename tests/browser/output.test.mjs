// The "Save and share" menu: images, recordings, links.

import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { seriousFindings } from "./harness/axe.mjs";
import { chooseOutput, eventually, screenshot, settle } from "./harness/browser.mjs";
import { downloaded, watchDownloads } from "./harness/downloads.mjs";
import { difference, statistics, thumbnail } from "./harness/images.mjs";
import { Stage } from "./harness/stage.mjs";

const stage = new Stage({
  resolution: "auto",
  view: {
    viewport: { width: 720, height: 405 },
    permissions: ["clipboard-read", "clipboard-write"],
  },
});

async function openSave(page, { format = "png", samples = "converged" } = {}) {
  await chooseOutput(page, "Save image");
  const dialog = page.getByRole("dialog", { name: "Save image" });
  await dialog.getByLabel("Format").selectOption(format);
  await dialog.getByLabel("Samples").selectOption(samples);
  return dialog;
}

async function saved(page, options) {
  const dialog = await openSave(page, options);
  return downloaded(page, () =>
    dialog.getByRole("button", { name: "Save", exact: true }).click(),
  );
}

/** By keys: Firefox sends no change of a value that its driver has filled in. */
async function enter(field, text) {
  await field.press("Control+a");
  await field.pressSequentially(text);
  await field.press("Tab");
}

/** The data window of an OpenEXR file: attributes follow the magic number and the version. */
function exrWindow(bytes) {
  assert.equal(bytes.readUInt32LE(0), 20000630, "not an OpenEXR file");
  const at = bytes.indexOf("dataWindow\0box2i\0") + "dataWindow\0box2i\0".length + 4;
  const [left, top, right, bottom] = [0, 4, 8, 12].map((offset) => bytes.readInt32LE(at + offset));
  return { width: right - left + 1, height: bottom - top + 1 };
}

stage.test("saved PNG and EXR images equal captures of the server", async () => {
  const { page } = await stage.sharedViewer();
  await settle(page, stage.server);
  const png = await saved(page);
  assert.match(png.name, /^shadow_objects\.png$/);
  const capture = await stage.server.call("frame.capture", { buffer: "output", format: "png" });
  const [mine, theirs] = [png.bytes, Buffer.from(capture.data, "base64")];
  const [a, b] = [await thumbnail(page, mine), await thumbnail(page, theirs)];
  assert.ok(difference(a, b) < 0.01, "the saved image differs");
  assert.ok(statistics(a).deviation > 0.03, "the saved image is nearly uniform");
  const exr = await saved(page, { format: "exr" });
  assert.match(exr.name, /\.exr$/);
  assert.deepEqual(exrWindow(exr.bytes), { width: capture.width, height: capture.height });
});

stage.test("an image is saved at once as it is, and a converged one can be cancelled", async () => {
  const { page } = await stage.sharedViewer();
  await settle(page, stage.server);
  // Converging takes so long that only what is there already can be saved.
  await stage.server.call("settings.patch", { patch: { accumulation: { max_samples: 65536 } } });
  await stage.server.call("camera.orbit", { yaw: 5, pitch: 0 });
  const jpeg = await saved(page, { format: "jpeg", samples: "now" });
  assert.match(jpeg.name, /\.jpg$/);
  assert.deepEqual([...jpeg.bytes.subarray(0, 2)], [0xff, 0xd8]);
  const toast = page.locator(".toast", { hasText: jpeg.name });
  assert.match(await toast.textContent(), /\d+ x \d+ pixels, \d+ samples?/);

  const downloads = watchDownloads(page);
  const dialog = await openSave(page);
  await dialog.getByRole("button", { name: "Save", exact: true }).click();
  const status = dialog.getByRole("status");
  await eventually(
    async () => /Rendering: \d+ of 65536 samples/.test(await status.textContent()),
    "progress",
  );
  assert.ok(await dialog.getByRole("progressbar").isVisible());
  await screenshot(page, "save_dialog");
  await dialog.getByRole("button", { name: "Cancel" }).click();
  await dialog.waitFor({ state: "hidden" });
  await stage.server.call("settings.patch", { patch: { accumulation: { max_samples: 4 } } });
  await settle(page, stage.server);
  assert.deepEqual(downloads(), [], "a cancelled image was saved");
  const again = await openSave(page);
  assert.ok(await again.getByRole("button", { name: "Save", exact: true }).isEnabled());
  await page.keyboard.press("Escape");
  await again.waitFor({ state: "hidden" });
});

stage.test("an image is saved in another size, with linked sides and progress", async () => {
  await stage.server.call("settings.patch", { patch: { accumulation: { max_samples: 8 } } });
  const { page } = await stage.sharedViewer();
  await settle(page, stage.server);
  const dialog = await openSave(page);
  const [width, height] = ["Width", "Height"].map((name) =>
    dialog.getByRole("textbox", { name }),
  );
  assert.deepEqual([await width.inputValue(), await height.inputValue()], ["720", "405"]);
  await enter(width, "960");
  assert.equal(await height.inputValue(), "540");
  await dialog.getByRole("button", { name: "Keep the aspect ratio" }).click();
  await enter(height, "99999");
  assert.equal(await height.inputValue(), "2160");
  await enter(height, "500");
  await dialog.getByLabel("Samples").selectOption({ label: "Quick: 8 samples" });
  await screenshot(page, "save_size");
  assert.deepEqual(await seriousFindings(page), []);
  const save = dialog.getByRole("button", { name: "Save", exact: true });
  const png = await downloaded(page, async () => {
    await save.click();
    await dialog.getByText(/Rendering: [1-9]\d* of 8 samples/).waitFor();
  });
  assert.deepEqual([png.bytes.readUInt32BE(16), png.bytes.readUInt32BE(20)], [960, 500]);
  await page.locator(".toast", { hasText: "960 x 500 pixels, 8 samples" }).waitFor();
  const sessions = async () => (await stage.server.call("session.list")).sessions.length;
  await eventually(async () => (await sessions()) === 1, "the copy to end");

  // Cancelling ends the copy, too.
  await stage.server.call("settings.patch", { patch: { accumulation: { max_samples: 65536 } } });
  const again = await openSave(page);
  await enter(again.getByRole("textbox", { name: "Width" }), "1000");
  await again.getByRole("button", { name: "Save", exact: true }).click();
  await eventually(async () => (await sessions()) === 2, "a copy");
  await again.getByRole("button", { name: "Cancel" }).click();
  await eventually(async () => (await sessions()) === 1, "the copy to end");
  await stage.server.call("settings.patch", { patch: { accumulation: { max_samples: 4 } } });
});

stage.test("a converged image waits for the path traced samples, in any size", async () => {
  const { page } = await stage.sharedViewer();
  const samples = (count) =>
    stage.server.call("settings.patch", {
      patch: { accumulation: { max_samples: 2 }, reference: { samples: count } },
    });
  await samples(65_536);
  await page.waitForFunction(() => !window.seen.frame.final && window.seen.frame.samples > 2);
  const dialog = await openSave(page);
  const options = await dialog.getByLabel("Samples").locator("option").allTextContents();
  assert.match(options[0], /^As it is now: \d+ path traced samples?$/);
  assert.equal(options.at(-1), "Converged: 65536 path traced samples");
  const save = dialog.getByRole("button", { name: "Save", exact: true });
  const downloads = watchDownloads(page);
  await save.click();
  await dialog.getByText(/^Rendering: \d+ of 65536 path traced samples$/).waitFor();
  await screenshot(page, "save_path_traced");
  assert.deepEqual(downloads(), []);
  await downloaded(page, () => samples(4));
  const toast = (text) => page.locator(".toast", { hasText: text });
  await toast(/: 720 x 405 pixels, \d+ path traced samples$/).waitFor();

  await openSave(page);
  await enter(dialog.getByRole("textbox", { name: "Width" }), "360");
  await downloaded(page, () => save.click());
  await toast(/: 360 x 20\d pixels, 4 path traced samples$/).waitFor();
  await samples(2);
});

stage.test("an image is saved with measurements and annotations, if there are any", async (t) => {
  const { page } = await stage.sharedViewer();
  await settle(page, stage.server);
  const refusal = await stage.server
    .call("frame.capture", { marks: true, samples: 1 })
    .then(() => "", (error) => String(error));
  if (refusal.includes("cannot be drawn")) return t.skip(refusal);
  const dialog = await openSave(page);
  const drawn = dialog.getByRole("switch", { name: "Measurements and annotations" });
  assert.equal(await drawn.isVisible(), false, "there are none yet");
  const { target, up } = await stage.server.call("camera.get");
  const end = target.map((value, axis) => value + 0.5 * up[axis]);
  const points = [{ position: target }, { position: end }];
  await stage.server.call("measurements.add", { kind: "distance", points });
  await drawn.waitFor();
  assert.equal(await drawn.isChecked(), false);
  await drawn.check();
  await screenshot(page, "save_marks");
  assert.deepEqual(await seriousFindings(page), []);
  await dialog.getByLabel("Format").selectOption("exr");
  assert.equal(await drawn.isVisible(), false, "values have none");
  await dialog.getByLabel("Format").selectOption("png");
  const save = dialog.getByRole("button", { name: "Save", exact: true });
  const marked = await downloaded(page, () => save.click());

  await openSave(page);
  assert.ok(await drawn.isChecked(), "the choice stays");
  await enter(dialog.getByRole("textbox", { name: "Width" }), "360");
  const small = await downloaded(page, () => save.click());
  await openSave(page);
  await drawn.uncheck();
  const plain = await downloaded(page, () => save.click());
  const [image, ...others] = await Promise.all(
    [plain, marked, small].map(({ bytes }) => thumbnail(page, bytes)),
  );
  for (const other of others) assert.ok(difference(image, other) > 1e-4, "nothing is drawn");
  assert.ok(difference(image, others[0]) < 0.2, "more than the marks is drawn");
  await stage.server.call("measurements.clear");
  await openSave(page);
  await drawn.waitFor({ state: "hidden" });
  await page.keyboard.press("Escape");
  await dialog.waitFor({ state: "hidden" });
});

stage.test("an image is saved without its background", async () => {
  const { page } = await stage.sharedViewer();
  await settle(page, stage.server);
  const dialog = await openSave(page);
  await dialog.getByLabel("Transparent").check();
  await screenshot(page, "save_transparent");
  assert.deepEqual(await seriousFindings(page), []);
  const png = await downloaded(page, () =>
    dialog.getByRole("button", { name: "Save", exact: true }).click(),
  );
  const colorType = png.bytes[25];
  assert.equal(colorType, 6, "the file has no alpha");
  const alphas = await page.evaluate(async (base64) => {
    const bytes = Uint8Array.from(atob(base64), (letter) => letter.charCodeAt(0));
    const bitmap = await createImageBitmap(new Blob([bytes], { type: "image/png" }));
    const context = new OffscreenCanvas(bitmap.width, bitmap.height).getContext("2d");
    context.drawImage(bitmap, 0, 0);
    const { data } = context.getImageData(0, 0, bitmap.width, bitmap.height);
    const count = (test) => data.filter((value, index) => index % 4 === 3 && test(value)).length;
    const all = data.length / 4;
    return { clear: count((a) => a === 0) / all, opaque: count((a) => a === 255) / all };
  }, png.bytes.toString("base64"));
  assert.ok(alphas.clear > 0.05 && alphas.opaque > 0.2, JSON.stringify(alphas));
  assert.ok(alphas.clear + alphas.opaque > 0.9, "hardly any pixel is at an edge");
  // Other formats have no alpha.
  const again = await openSave(page, { format: "jpeg" });
  assert.equal(await again.getByLabel("Transparent").isVisible(), false);
  await page.keyboard.press("Escape");
  await again.waitFor({ state: "hidden" });
});

stage.test("the copied image is in the clipboard", async () => {
  const { page } = await stage.sharedViewer();
  await settle(page, stage.server);
  await chooseOutput(page, "Copy image");
  await page.locator(".toast", { hasText: "Image copied to the clipboard" }).waitFor();
  const base64 = await page.evaluate(async () => {
    const [item] = await navigator.clipboard.read();
    const bytes = new Uint8Array(await (await item.getType("image/png")).arrayBuffer());
    return btoa(Array.from(bytes, (byte) => String.fromCharCode(byte)).join(""));
  });
  const png = Buffer.from(base64, "base64");
  const capture = await stage.server.call("frame.capture", { buffer: "output", format: "png" });
  assert.deepEqual([png.readUInt32BE(16), png.readUInt32BE(20)], [capture.width, capture.height]);
  const expected = await thumbnail(page, Buffer.from(capture.data, "base64"));
  assert.ok(difference(await thumbnail(page, png), expected) < 0.01, "the copied image differs");
});

/** Plays a video in a new page; gives its size and the number of different frames. */
async function playVideo(bytes) {
  const page = await (await stage.context()).newPage();
  await page.goto("about:blank");
  return page.evaluate(async (base64) => {
    const video = document.createElement("video");
    const content = Uint8Array.from(atob(base64), (letter) => letter.charCodeAt(0));
    video.src = URL.createObjectURL(new Blob([content]));
    video.muted = true;
    const ended = new Promise((resolve, reject) => {
      video.onended = resolve;
      video.onerror = () => reject(new Error(video.error.message));
    });
    const colours = new Set();
    const canvas = new OffscreenCanvas(16, 9);
    const context = canvas.getContext("2d", { willReadFrequently: true });
    const readFrame = () => {
      context.drawImage(video, 0, 0, 16, 9);
      colours.add(context.getImageData(0, 0, 16, 9).data.join());
      video.requestVideoFrameCallback(readFrame);
    };
    video.requestVideoFrameCallback(readFrame);
    await video.play();
    await ended;
    return { width: video.videoWidth, height: video.videoHeight, different: colours.size };
  }, bytes.toString("base64"));
}

stage.test("a recording is a playable video with different frames", async () => {
  const { page } = await stage.sharedViewer();
  await stage.server.call("animation.play", { clip: "moving_objects_light" });
  const drawn = () =>
    page.evaluate(() => Object.values(window.seen.drawn).reduce((sum, count) => sum + count, 0));
  await chooseOutput(page, "Record a video");
  const stop = page.getByRole("button", { name: "Stop recording" });
  await stop.waitFor();
  const before = await drawn();
  await eventually(async () => (await drawn()) >= before + 12, "twelve frames", 60_000);
  const { width, height } = await page.evaluate(() => window.seen.frame);
  const { name, path, bytes } = await downloaded(page, async () => {
    await stop.getByText(/Recording 0:0[1-9]/).waitFor();
    await screenshot(page, "recording");
    await stop.click();
  });
  assert.equal(await stop.isVisible(), false);
  await stage.server.call("animation.pause");
  const types = ["video/mp4;codecs=avc1.42e01e", "video/mp4;codecs=vp09.00.10.08"];
  const mp4 = await page.evaluate((all) => all.some(MediaRecorder.isTypeSupported), types);
  assert.match(name, mp4 ? /\.mp4$/ : /\.webm$/);
  await page.locator(".toast", { hasText: `Saved ${name}` }).waitFor();
  const video = await playVideo(bytes);
  assert.ok(Math.abs(video.width / video.height - width / height) < 0.05, JSON.stringify(video));
  assert.ok(video.different >= 4, `only ${video.different} different frames`);
  const probe = spawnSync("ffprobe", ["-v", "error", "-count_frames", "-show_streams", path]);
  if (probe.status === null) return; // ffprobe is not installed
  assert.match(String(probe.stdout), /codec_type=video/, String(probe.stderr));
  const frames = Number(/nb_read_frames=(\d+)/.exec(String(probe.stdout))?.[1]);
  assert.ok(frames >= 6, `${frames} frames`);
});
