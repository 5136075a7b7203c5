// The list of scenes: search, favourites, and what survives a change of scene.

import assert from "node:assert/strict";
import { mkdtempSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after } from "node:test";
import { seriousFindings } from "./harness/axe.mjs";
import { eventually, firstFrame, screenshot } from "./harness/browser.mjs";
import { Stage } from "./harness/stage.mjs";

const stage = new Stage({ view: { viewport: { width: 900, height: 700 } } });

// A server that has no thumbnails yet.
const cache = mkdtempSync(join(tmpdir(), "heliograph-cache-"));
after(() => rmSync(cache, { recursive: true, force: true }));
const fresh = new Stage({
  view: { viewport: { width: 1280, height: 720 } },
  variables: { XDG_CACHE_HOME: cache },
});

const namesIn = (page) =>
  page
    .locator("select[name=scene] option")
    .evaluateAll((options) => options.map((option) => option.textContent));

async function openGallery(page) {
  await page.getByRole("button", { name: "Show thumbnails of all scenes" }).click();
  return page.locator("#scene-gallery");
}

stage.test("scenes are found by a part of their name, which is never truncated", async () => {
  const { page } = await stage.watch();
  const gallery = await openGallery(page);
  const search = gallery.getByRole("searchbox", { name: "Search scenes" });
  await search.fill("sponza 1");
  await eventually(async () => (await gallery.locator(".tile:visible").count()) === 1, "one scene");
  assert.equal(await gallery.locator(".tile:visible").textContent(), "glossy_sponza_1");
  await search.fill("nothing");
  await gallery.getByText("No scene has this name.").waitFor();
  await search.fill("");
  const cut = await gallery
    .locator(".tile-name")
    .evaluateAll((names) => names.filter((name) => name.scrollWidth > name.clientWidth).length);
  assert.equal(cut, 0, "truncated names");
  await screenshot(page, "scene_list");
  assert.deepEqual(await seriousFindings(page), []);
});

stage.test("favourites come first and persist over a reload", async () => {
  const { page } = await stage.watch();
  const before = await namesIn(page);
  assert.notEqual(before[0], "shadow_objects");
  const gallery = await openGallery(page);
  const star = gallery.getByRole("button", { name: "Favourite shadow_objects" });
  await star.press("Enter");
  assert.equal(await star.getAttribute("aria-pressed"), "true");
  await eventually(async () => (await namesIn(page))[0] === "★ shadow_objects", "the favourite");
  await page.reload();
  await firstFrame(page);
  assert.equal((await namesIn(page))[0], "★ shadow_objects");
  const first = (await openGallery(page)).locator(".tile").first();
  assert.equal(await first.textContent(), "shadow_objects");
  await star.click();
  assert.deepEqual(await namesIn(page), before);
});

stage.test("the chosen environment stays when another scene is loaded", async () => {
  const { page } = await stage.watch();
  const environment = page.locator("select[name=environment]");
  await environment.selectOption("white");
  const chosen = async () => (await stage.server.call("environment.list")).current;
  await eventually(async () => (await chosen()) === "white", "the environment");
  await page.locator("select[name=scene]").selectOption("mirror");
  await page.waitForFunction(() => document.title.startsWith("mirror"));
  await firstFrame(page);
  assert.equal(await chosen(), "white");
  assert.equal(await environment.inputValue(), "white");
});

fresh.test(
  "the server renders thumbnails of its scenes while it is idle, and keeps them",
  async () => {
    const { page } = await fresh.watch();
    await fresh.server.call("animation.play", { clip: "moving_objects_light" });
    await page.waitForFunction(() => window.seen.frame && !window.seen.frame.final);
    await page.getByRole("button", { name: "Show thumbnails of all scenes" }).click();
    const tile = page.locator(".tile", { hasText: "shadow_objects" });
    await tile.waitFor();
    assert.equal(await tile.getAttribute("aria-pressed"), "true");
    const drawn = () =>
      page.evaluate(() => Object.values(window.seen.drawn).reduce((sum, count) => sum + count, 0));
    const before = await drawn();
    await eventually(async () => (await drawn()) > before + 8, "moving frames", 60_000);
    const { sessions } = await fresh.server.call("session.list");
    assert.equal(sessions.length, 1, "previews were rendered during an animation");

    await fresh.server.call("animation.pause");
    await tile.locator("img").waitFor({ timeout: 60_000 });
    const missing = page.locator(".tile", { hasText: "mirror" }).locator("img");
    await missing.waitFor({ timeout: 60_000 });
    assert.ok(await missing.evaluate((image) => image.naturalWidth >= 200));
    await page.locator(".tile", { hasText: "furnace" }).locator("img").waitFor({ timeout: 60_000 });
    await screenshot(page, "scene_gallery");
    assert.equal((await fresh.server.call("scene.list")).current, "shadow_objects");
    // The server keeps them: another browser has them at once, while a clip plays.
    await fresh.server.call("animation.play", { clip: "moving_objects_light" });
    const other = await fresh.watch();
    await other.page.getByRole("button", { name: "Show thumbnails of all scenes" }).click();
    const kept = other.page.locator(".tile", { hasText: "mirror" }).locator("img");
    await kept.waitFor({ timeout: 20_000 });
    assert.deepEqual(
      await kept.evaluate((image) => [image.naturalWidth, image.naturalHeight]),
      [240, 135],
    );
    await fresh.server.call("animation.pause");
  },
);
