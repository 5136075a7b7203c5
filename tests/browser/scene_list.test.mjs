// The list of scenes: search, favourites, and what survives a change of scene.

import assert from "node:assert/strict";
import { seriousFindings } from "./harness/axe.mjs";
import { eventually, firstFrame, screenshot } from "./harness/browser.mjs";
import { Stage } from "./harness/stage.mjs";

const stage = new Stage({ view: { viewport: { width: 900, height: 700 } } });

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
