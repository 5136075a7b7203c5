// Uploads of scenes and environments: accepted, rejected, disabled; a server without scenes.

import assert from "node:assert/strict";
import { mkdirSync, mkdtempSync, readFileSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after } from "node:test";
import { seriousFindings } from "./harness/axe.mjs";
import { eventually, firstFrame, screenshot, unfoldAll } from "./harness/browser.mjs";
import { sceneRoot } from "./harness/environment.mjs";
import { Stage } from "./harness/stage.mjs";

const mirror = readFileSync(join(sceneRoot, "mirror.glb"));
const folder = mkdtempSync(join(tmpdir(), "heliograph-uploads-"));
after(() => rmSync(folder, { recursive: true, force: true }));

const view = { viewport: { width: 900, height: 640 } };
const open = new Stage({
  serverArguments: ["--uploads", folder, "--max-upload-bytes", String(mirror.length + 1000)],
  view,
});
const closed = new Stage({ view });
const emptyFolder = join(folder, "empty");
mkdirSync(emptyFolder);
const empty = new Stage({
  scene: null,
  serverArguments: ["--uploads", join(folder, "of_empty"), "--scene-root", emptyFolder],
  view,
});

/** A Radiance file of 8 x 4 pixels of one colour. */
const panorama = Buffer.concat([
  Buffer.from("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 4 +X 8\n"),
  Buffer.alloc(4 * 32, Buffer.from([40, 90, 200, 128])),
]);

/** Drops a file on the page as a file manager does. */
async function drop(page, name, bytes) {
  const transfer = await page.evaluateHandle(
    ({ name: fileName, base64 }) => {
      const content = Uint8Array.from(atob(base64), (letter) => letter.charCodeAt(0));
      const transferred = new DataTransfer();
      transferred.items.add(new File([content], fileName));
      return transferred;
    },
    { name, base64: Buffer.from(bytes).toString("base64") },
  );
  await page.dispatchEvent("body", "dragenter", { dataTransfer: transfer });
  await page.locator(".drop-veil").waitFor();
  await screenshot(page, "drop");
  await page.dispatchEvent("body", "dragover", { dataTransfer: transfer });
  await page.dispatchEvent("body", "drop", { dataTransfer: transfer });
  assert.equal(await page.locator(".drop-veil").isVisible(), false);
}

async function toastAfterDrop(page, name, bytes) {
  await drop(page, name, bytes);
  const toast = page.locator(".toast");
  const text = await toast.locator(".toast-text").innerText();
  await screenshot(page, `rejected_${name.replace(/\W/g, "_")}`);
  await toast.getByRole("button", { name: "Dismiss" }).click();
  assert.equal((await open.server.call("scene.list")).current, "shadow_objects");
  return text;
}

open.test("a dropped file is uploaded, listed and loaded", async () => {
  const { page } = await open.watch();
  await drop(page, "My mirror (1).glb", mirror);
  await eventually(
    async () => (await open.server.call("scene.list")).current === "My_mirror_1",
    "the dropped scene",
    60_000,
  );
  await firstFrame(page);
  assert.equal(await page.locator("select[name=scene]").inputValue(), "My_mirror_1");
  await open.server.call("scene.load", { name: "shadow_objects" });
});

/** One red texel. */
const redImage = Buffer.from(
  "iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAADUlEQVR42mP8z8BQDwAEhQGAhKmMIQAAAABJRU5ErkJggg==",
  "base64",
);

open.test("an image replaces the texture of a material, by keyboard, and is undone", async () => {
  const { page } = await open.watch();
  await unfoldAll(page);
  const [{ name: material }] = (await open.server.call("materials.list")).materials;
  await page.locator("select[name=material]").selectOption(material);
  const texture = async () =>
    (await open.server.call("textures.list")).textures.find(
      (one) => one.material === material && one.slot === "base_color",
    );
  const replaced = (image) =>
    eventually(async () => (await texture())?.image === image, `the texture ${image}`, 60_000);
  const replace = page.getByRole("button", { name: "Replace the base color texture by a file" });
  const chooser = page.waitForEvent("filechooser");
  await replace.press("Enter");
  await (await chooser).setFiles({ name: "red.png", mimeType: "image/png", buffer: redImage });
  await replaced("red");
  const chosen = page.locator("select[name=texture_base_color]");
  await eventually(async () => (await chosen.inputValue()) === "image red", "the chosen image");
  await firstFrame(page);
  await chosen.scrollIntoViewIfNeeded();
  for (const scheme of ["dark", "light"]) {
    await page.emulateMedia({ colorScheme: scheme });
    await screenshot(page, `textures_${scheme}`);
    assert.deepEqual(await seriousFindings(page), []);
  }
  const step = `base color texture of ${material}`;
  await page.getByRole("button", { name: `Undo: ${step} (Ctrl Z)` }).click();
  await replaced(undefined);
  await page.getByRole("button", { name: `Redo: ${step} (Ctrl Shift Z)` }).click();
  await replaced("red");
  await page.getByRole("button", { name: "Restore the base color texture of the file" }).press("Enter");
  await replaced(undefined);
});

open.test("a file can be uploaded by the file chooser", async () => {
  const { page } = await open.watch();
  const chooser = page.waitForEvent("filechooser");
  await page.getByRole("button", { name: "Upload", exact: true }).press("Enter");
  await (await chooser).setFiles({ name: "chosen.glb", mimeType: "", buffer: mirror });
  await eventually(
    async () => (await open.server.call("scene.list")).current === "chosen",
    "the chosen scene",
    60_000,
  );
  await open.server.call("scene.load", { name: "shadow_objects" });
});

open.test("an environment is uploaded, shown, and found by its thumbnail", async () => {
  const { page } = await open.watch({ expectErrors: true }); // the browser reports failed requests
  await drop(page, "Blue sky.hdr", panorama);
  const chosen = async () => (await open.server.call("environment.list")).current;
  await eventually(async () => (await chosen()) === "Blue_sky", "the dropped environment");
  const choice = page.locator("select[name=environment]");
  await eventually(async () => (await choice.inputValue()) === "Blue_sky", "the chosen environment");
  await page.getByRole("button", { name: "Show thumbnails of all environments" }).click();
  const tiles = page.getByRole("group", { name: "Environments" });
  const tile = tiles.getByRole("button", { name: "Blue_sky", exact: true });
  await eventually(
    async () => (await tile.getAttribute("aria-pressed")) === "true",
    "its mark as chosen",
  );
  await eventually(
    () => tile.locator("img").evaluate((image) => image.naturalWidth === 160),
    "its thumbnail",
  );
  await screenshot(page, "environments");
  assert.deepEqual(await seriousFindings(page), []);
  await tiles.getByRole("button", { name: "studio" }).press("Enter");
  await eventually(async () => (await chosen()) === "studio", "the studio");
  const text = await toastAfterDrop(page, "broken.exr", Buffer.from("not an environment\n"));
  assert.match(text, /^broken\.exr is not an environment in the format \.hdr or \.exr\./);
  const chooser = page.waitForEvent("filechooser");
  await page.getByRole("button", { name: "Upload an environment" }).press("Enter");
  await (await chooser).setFiles({ name: "cut.hdr", mimeType: "", buffer: panorama.subarray(0, 90) });
  await page.locator(".toast", { hasText: "cut.hdr is incomplete: the file ends early." }).waitFor();
  await open.server.call("environment.set", { name: null });
});

async function put(kind, name, body) {
  const url = new URL(`api/v1/${kind}/${name}`, open.server.url);
  assert.equal((await fetch(url, { method: "PUT", body })).status, 201);
}

const galleryOf = (page, kind) => page.getByRole("button", { name: `Show thumbnails of all ${kind}` });

/** Deletes an upload of this list, and gives what has the focus then. */
async function deleteByKeyboard(list, name) {
  await list.getByRole("button", { name: `Delete ${name}` }).press("Enter");
  await list.getByRole("button", { name: `Confirm: delete ${name}` }).press("Enter");
  await list.getByText(name, { exact: true }).waitFor({ state: "detached" });
  await eventually(
    () => list.evaluate((node) => node.contains(document.activeElement)),
    "the focus in the list",
  );
}

open.test("uploads are deleted by keyboard after a question, for all viewers", async () => {
  for (const name of ["doomed", "kept"]) {
    await put("scenes", name, mirror);
    await put("environments", name, panorama);
    await put("images", name, redImage);
  }
  // The browser reports failed requests, such as for the image of what was deleted just now.
  const { page } = await open.watch({ expectErrors: true });
  const other = await open.watch({ expectErrors: true });
  await unfoldAll(page);
  for (const kind of ["scenes", "environments"]) {
    await galleryOf(page, kind).click();
    await galleryOf(other.page, kind).click();
  }
  const scenes = page.locator("#scene-gallery");
  assert.equal(await scenes.getByRole("button", { name: "Delete shadow_objects" }).count(), 0);
  const remove = scenes.getByRole("button", { name: "Delete doomed" });
  await remove.press("Enter");
  await scenes.getByRole("button", { name: "Confirm: delete doomed" }).waitFor();
  await screenshot(page, "delete_upload");
  assert.deepEqual(await seriousFindings(page), []);
  await page.keyboard.press("Tab");
  await scenes.getByRole("button", { name: "Delete doomed", exact: true }).waitFor();
  // The second click of a double click does not confirm.
  await scenes.getByRole("button", { name: "Delete kept" }).dblclick();
  await scenes.getByRole("button", { name: "Confirm: delete kept" }).waitFor();
  // A question stays open when others delete.
  const others = other.page.locator("#scene-gallery");
  await others.getByRole("button", { name: "Delete kept" }).press("Enter");
  await deleteByKeyboard(scenes, "doomed");
  await deleteByKeyboard(page.locator("#environment-gallery"), "doomed");
  await deleteByKeyboard(page.getByRole("list", { name: "Uploaded images" }), "doomed");
  await page.locator(".toast", { hasText: "doomed was deleted" }).waitFor();
  for (const gallery of ["#scene-gallery", "#environment-gallery"]) {
    await other.page.locator(gallery).getByText("kept", { exact: true }).waitFor();
    await other.page
      .locator(gallery)
      .getByText("doomed", { exact: true })
      .waitFor({ state: "detached" });
  }
  await others.getByRole("button", { name: "Confirm: delete kept" }).waitFor();
  for (const [method, kind] of [
    ["scene.list", "scenes"],
    ["environment.list", "environments"],
    ["images.list", "images"],
  ]) {
    const names = (await open.server.call(method))[kind].map(({ name }) => name);
    assert.ok(names.includes("kept") && !names.includes("doomed"), `${kind}: ${names}`);
  }
});

open.test("a scene that is shown stays when it is deleted, and a refusal is told", async () => {
  await put("scenes", "shown", mirror);
  await open.server.call("scene.load", { name: "shown" });
  const { page } = await open.watch({ expectErrors: true }); // the browser reports failed requests
  await galleryOf(page, "scenes").click();
  const scenes = page.locator("#scene-gallery");
  await page.route("**/api/v1/scenes/shown", (route) =>
    route.fulfill({ status: 403, body: "This token is read-only and cannot delete uploads.\n" }),
  );
  const remove = scenes.getByRole("button", { name: "Delete shown" });
  await remove.press("Enter");
  await remove.press("Enter");
  await page
    .locator(".toast", { hasText: "shown was not deleted: This token is read-only" })
    .waitFor();
  assert.equal(await remove.getAttribute("aria-label"), "Delete shown");
  await page.unroute("**/api/v1/scenes/shown");
  await deleteByKeyboard(scenes, "shown");
  assert.equal(await page.locator("select[name=scene]").inputValue(), "shown");
  assert.equal((await open.server.call("scene.info")).name, "shown");
  await page.reload();
  await firstFrame(page);
  assert.equal(await page.locator("select[name=scene]").inputValue(), "shown");
  await open.server.call("scene.load", { name: "shadow_objects" });
});

empty.test("a server without scenes says how to bring one, and shows it", async () => {
  const { page } = await empty.open();
  await page.getByRole("heading", { name: "No scenes found" }).waitFor();
  await page.getByText("Drop a .glb file here").waitFor();
  await screenshot(page, "no_scenes");
  assert.deepEqual(await seriousFindings(page), []);
  await drop(page, "first.glb", mirror);
  await firstFrame(page);
  assert.equal((await empty.server.call("scene.list")).current, "first");
  await page.locator("select[name=environment]").waitFor();
});

open.test("an invalid file is rejected with a reason", async () => {
  const { page } = await open.watch({ expectErrors: true }); // the browser reports failed requests
  await page.waitForFunction(() => document.title.startsWith("shadow_objects"));
  const large = await toastAfterDrop(page, "large.glb", Buffer.alloc(mirror.length + 1001, 7));
  assert.match(large, /large\.glb has .* kB; the server accepts up to .* kB/);
  const text = await toastAfterDrop(page, "text.glb", Buffer.from("not a scene"));
  assert.match(text, /^text\.glb is incomplete: the file ends early\./);
  const truncated = await toastAfterDrop(
    page,
    "truncated.glb",
    mirror.subarray(0, mirror.length - 10),
  );
  assert.match(truncated, /^truncated\.glb is incomplete: the file ends early\./);
  const other = await toastAfterDrop(page, "other.glb", Buffer.alloc(100, 7));
  assert.match(other, /^other\.glb is not a glTF file\./);
  const nameTaken = await toastAfterDrop(page, "mirror.glb", mirror);
  assert.match(nameTaken, /has its own scene mirror/);
  assert.match(await toastAfterDrop(page, "scene.gltf", mirror), /^Only \.glb files/);
});

closed.test("disabled uploads are reported before sending the file", async () => {
  const { page } = await closed.watch();
  assert.equal(await page.getByRole("button", { name: "Upload", exact: true }).isVisible(), false);
  await drop(page, "mirror.glb", mirror);
  await page.locator(".toast", { hasText: "This server does not accept uploads" }).waitFor();
});
