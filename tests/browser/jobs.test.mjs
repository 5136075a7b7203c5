// Jobs in the web client: "Render this view" creates one, the page at /jobs shows what becomes of it.

import assert from "node:assert/strict";
import { mkdtempSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after } from "node:test";
import { seriousFindings } from "./harness/axe.mjs";
import { eventually, screenshot } from "./harness/browser.mjs";
import { downloaded } from "./harness/downloads.mjs";
import { Stage } from "./harness/stage.mjs";

const folder = mkdtempSync(join(tmpdir(), "heliograph-jobs-"));
after(() => rmSync(folder, { recursive: true, force: true }));
const stage = new Stage({
  view: { viewport: { width: 720, height: 405 } },
  serverArguments: ["--jobs", folder],
});
const small = { scene: "shadow_objects", width: 64, samples: 1 };
const slow = {
  ...small,
  width: 512,
  samples: 65536,
  settings: { accumulation: { max_samples: 65536 } },
};

const openJobs = (options) =>
  stage.open({ url: new URL("jobs", stage.server.url).href, ...options });
const card = (page, name) => page.getByRole("article", { name });

stage.test("a view is rendered as a job, whose files the page of jobs shows", async () => {
  const empty = await openJobs();
  await empty.page.getByText("There are no jobs.").waitFor();

  const { page } = await stage.watch();
  await eventually(async () => {
    await page.getByRole("button", { name: "Save and share" }).click();
    const item = page.getByRole("menuitem", { name: "Render this view" });
    const shown = await item.isVisible();
    if (shown) await item.click();
    else await page.keyboard.press("Escape");
    return shown;
  }, "the menu offers to render the view");
  const dialog = page.getByRole("dialog", { name: "Render this view" });
  await dialog.getByLabel("Content").selectOption("36");
  assert.equal(await dialog.getByLabel("Format").inputValue(), "mp4");
  await dialog.getByLabel("Content").selectOption("");
  await dialog.getByLabel("Format").selectOption("webp");
  await dialog.getByLabel("Quality").selectOption("0.95");
  await dialog.getByLabel("Width, pixels").fill("96");
  await dialog.getByLabel("Transparent").check();
  await dialog.getByRole("button", { name: "Render", exact: true }).click();
  await dialog.getByText("was queued").waitFor();
  assert.deepEqual(await seriousFindings(page), []);
  await screenshot(page, "render_dialog");

  const opened = page.context().waitForEvent("page");
  await dialog.getByRole("link", { name: "Show the jobs" }).click();
  const jobs = await opened;
  const job = card(jobs, "shadow_objects, 96 x 54");
  await job.getByText("Done", { exact: true }).waitFor({ timeout: 60_000 });
  const image = job.locator("img");
  await image.waitFor();
  await eventually(() => image.evaluate((node) => node.naturalWidth === 96), "the image is shown");
  const { name, bytes: archive } = await downloaded(jobs, () =>
    job.getByRole("link", { name: /^Download ZIP of/ }).click(),
  );
  assert.equal(name, "shadow_objects__96_x_54.zip");
  assert.equal(archive.readUInt32LE(0), 0x04034b50, "no ZIP archive");
  assert.ok(archive.includes("shadow_objects.webp"));
});

stage.test("jobs are shown as they run, and can be cancelled from the keyboard", async () => {
  const create = (name, ...entries) => stage.server.call("job.create", { name, entries });
  await create("endless", { ...small, output: "first.png" }, { ...slow, output: "second.png" });
  await create("next", small);
  await create("urgent", small);
  const { page } = await openJobs();
  const running = card(page, "endless");
  await running.getByText(/^1 of 2 images, about /).waitFor({ timeout: 60_000 });
  await running.getByRole("link", { name: "first.png" }).waitFor();
  await page.getByRole("heading", { name: "Waiting (2)" }).waitFor();
  await screenshot(page, "jobs_running");
  assert.deepEqual(await seriousFindings(page), []);
  await card(page, "urgent").getByRole("button", { name: "Cancel urgent" }).focus();
  await page.keyboard.press("Enter");
  await card(page, "urgent").getByText("Canceled", { exact: true }).waitFor();
  await running.getByRole("button", { name: "Cancel endless" }).press("Enter");
  await running.getByText("Canceled", { exact: true }).waitFor({ timeout: 20_000 });
  await running.getByRole("link", { name: /^Download ZIP of/ }).waitFor();
  await card(page, "next").getByText("Done", { exact: true }).waitFor({ timeout: 30_000 });
});

stage.test("failures are told, and on a phone in light colours the page fits", async () => {
  await stage.server.call("job.create", {
    name: "broken",
    entries: [small, { ...small, clip: "no such clip", output: "b.png" }],
  });
  const { page } = await openJobs({
    viewport: { width: 390, height: 844 },
    colorScheme: "light",
  });
  const broken = card(page, "broken");
  await broken.getByText("Partly failed").waitFor({ timeout: 60_000 });
  await broken.getByText(/Entry 2, shadow_objects: .*clip/).waitFor();
  await screenshot(page, "jobs_phone");
  const [content, window] = await page.evaluate(() => [
    document.documentElement.scrollWidth,
    innerWidth,
  ]);
  assert.ok(content <= window, `the page is ${content} wide`);
  assert.deepEqual(await seriousFindings(page), []);
});

stage.test("a server without jobs says so, and offers none", async () => {
  await stage.restartServer(stage.serverArguments.slice(2));
  const { page: jobs } = await openJobs();
  await jobs.getByText("This server renders no jobs").waitFor();
  const { page } = await stage.watch();
  await page.getByRole("button", { name: "Save and share" }).click();
  await page.getByRole("menuitem", { name: "Save image" }).waitFor();
  assert.equal(await page.getByRole("menuitem", { name: /Render|Jobs/ }).count(), 0);
});
