// The page of the paper's figures in a real browser: every figure is there and labelled, and what
// is drawn are the numbers of the CSV files beside it. HELIOGRAPH_PAPER_PAGE is its folder.

import assert from "node:assert/strict";
import { existsSync, readFileSync, readdirSync } from "node:fs";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { pathToFileURL } from "node:url";
import { seriousFindings } from "./harness/axe.mjs";
import { launchBrowser } from "./harness/browser.mjs";
import { chromiumPath } from "./harness/environment.mjs";
import { groupBy, mean, readCsv } from "./harness/csv.mjs";

const folder = process.env.HELIOGRAPH_PAPER_PAGE;

// What ctest reports as "skipped".
function skip(reason) {
  console.log(`skipped: ${reason}`);
  process.exit(77);
}
if (!existsSync(chromiumPath)) skip(`no Chromium at ${chromiumPath}`);
if (!existsSync(join(folder, "data/figures.json"))) skip(`no page of figures in ${folder}`);

const figures = JSON.parse(readFileSync(join(folder, "data/figures.json"), "utf8"));
const tables = Object.fromEntries(
  readdirSync(join(folder, "data"))
    .filter((name) => name.endsWith(".csv"))
    .map((name) => [name, readCsv(join(folder, "data", name))]),
);
const drawn = [5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16, 17].map((number) => `figure-${number}`);
const plots = [...drawn, "tables-1-2", "blur-iterations", "pareto", "scenes-ssim", "indirect"];

let browser;
let page;
const errors = [];

async function open(options = {}) {
  const context = await browser.newContext(options);
  const opened = await context.newPage();
  opened.on("console", (message) => errors.push(message.text()));
  opened.on("pageerror", (error) => errors.push(error.message));
  await opened.goto(pathToFileURL(join(folder, "index.html")).href);
  return opened;
}

before(async () => {
  browser = await launchBrowser();
  page = await open();
});
after(() => browser.close());

/** The numbers that a line or bars must show, by x, from the rows of the CSV. */
function expectedOf({ file, x, y, stages, passes, value, ...filters }) {
  const rows = tables[file].filter(
    (row) =>
      Object.entries(filters).every(([name, wanted]) => wanted === null || row[name] === wanted) &&
      (!stages || stages.includes(row.stage)),
  );
  if (passes) {
    const at = rows.filter((row) => Number(row.value) === value);
    const times = passes.map((name) => Number(at.find((row) => row.pass === name)[y]));
    return times.map((ms) => ms / mean(times));
  }
  const key = filters.scene === null ? "scene" : x;
  const groups = [...groupBy(rows, (row) => row[key])];
  if (key !== "scene") groups.sort(([a], [b]) => Number(a) - Number(b));
  // The passes of a frame add up; seeds and movements are averaged.
  const of = (group) =>
    stages
      ? mean([...groupBy(group, (row) => row.movement)].map(([, one]) =>
          one.reduce((sum, row) => sum + Number(row[y]), 0)))
      : mean(group.map((row) => Number(row[y])));
  return new Map(groups.map(([name, group]) => [name, of(group)]));
}

/** What the SVG shows: the heights of bars or the places of a line's points, in its own units. */
function shown(id, count) {
  const path = (element) =>
    [...element.getAttribute("d").matchAll(/[ML]\s*([-\d.]+)\s+([-\d.]+)/g)].map((m) => +m[2]);
  const line = document.getElementById(id);
  if (line) {
    const marks = [...line.querySelectorAll("use")].map((mark) => +mark.getAttribute("y"));
    return { points: marks.length === count ? marks : path(line.querySelector("path")) };
  }
  const bars = [];
  for (let index = 0; index < count; ++index) {
    const ys = path(document.getElementById(`${id}-${index}`).querySelector("path"));
    bars.push(Math.max(...ys) - Math.min(...ys));
  }
  return { bars };
}

test("every figure, table and sheet of the paper is there and labelled", async () => {
  for (const key of plots) {
    const section = page.locator(`#${key}`);
    assert.equal(await section.count(), 1, key);
    assert.match(await section.locator("h3").first().textContent(), /\w{4,}/);
    assert.ok((await section.locator(".plot").getAttribute("aria-label")).length > 10, key);
    const words = await section.locator("svg text").allTextContents();
    assert.ok(
      words.some((word) => /SSIM|milliseconds|frames per second|of the mean/.test(word)),
      `${key} has no label of its y axis: ${words}`,
    );
  }
  for (const key of drawn) {
    const words = (await page.locator(`#${key} svg text`).allTextContents()).join(" ");
    assert.match(words, /surface roughness|shadow angle/, `${key}: x axis`);
    assert.match(words, /\(a\).*\(b\)/, `${key}: panels`);
    assert.match(words, /our SVGF|rectification|blur|tone mapping/, `${key}: legend`);
  }
  for (const key of ["figure-18", "figure-19"]) {
    assert.ok((await page.locator(`#${key} td img`).count()) >= 4, key);
  }
  assert.equal(await page.locator("#tables table tbody tr").first().locator("td").count(), 3);
  assert.ok(existsSync(join(folder, "paper.pdf")));
});

test("the numbers of the plots are those of the CSV files", async () => {
  let compared = 0;
  for (const [key, figure] of Object.entries(figures)) {
    for (const series of figure.series) {
      if (!series.source) continue;
      const expected = expectedOf(series.source);
      const numbers = Array.isArray(expected)
        ? expected
        : series.x.map((x) => expected.get([...expected.keys()].find((name) =>
            typeof x === "string" ? name === x : Number(name) === x)));
      const seen = await page.evaluate(
        ([source, id, count]) => new Function(`return (${source})`)()(id, count),
        [shown.toString(), series.id, numbers.length],
      ).catch((error) => assert.fail(`${series.id}: ${error.message}`));
      const [zero, one] = figure.scales[series.panel].y;
      const [drawnValues, reach] = seen.points
        ? [seen.points.map((y) => (y - zero) / one), Math.abs(1 / one)]
        : [seen.bars.map((height) => height / Math.abs(one)), Math.abs(1 / one)];
      assert.equal(drawnValues.length, numbers.length, series.id);
      numbers.forEach((number, index) => {
        // A hundredth of a point of the drawing.
        assert.ok(
          Math.abs(number - drawnValues[index]) <= 0.01 * reach + 1e-5,
          `${key}, ${series.id}: ${drawnValues[index]} is drawn for ${number}`,
        );
        compared += 1;
      });
    }
  }
  assert.ok(compared > 150, `${compared} numbers`);
});

test("a slider compares two images by keyboard", async () => {
  const compare = page.locator(".compare").first();
  const slider = compare.getByRole("slider");
  const clip = () => compare.locator(".over").evaluate((node) => node.style.clipPath);
  await slider.focus();
  const earlier = await clip();
  await page.keyboard.press("ArrowRight");
  assert.notEqual(await clip(), earlier);
  const right = compare.getByLabel("Right");
  await right.selectOption({ label: "best: difference" });
  const image = compare.locator(".over img");
  assert.match(await image.getAttribute("src"), /best-difference\.png$/);
  await image.evaluate((node) => node.decode());
  assert.match(await image.getAttribute("alt"), /best: difference/);
});

test("all images load", async () => {
  await page.evaluate(async () => {
    for (const image of document.images) image.loading = "eager";
    await Promise.all([...document.images].map((image) => image.decode()));
  });
  assert.ok((await page.evaluate(() => document.images.length)) > 20);
});

/** Contrast of the text of plots with the page (WCAG 2). */
function contrast() {
  const luminance = (color) => {
    const [r, g, b] = color.match(/[\d.]+/g).map((part) => {
      const value = part / 255;
      return value <= 0.04045 ? value / 12.92 : ((value + 0.055) / 1.055) ** 2.4;
    });
    return 0.2126 * r + 0.7152 * g + 0.0722 * b;
  };
  const text = document.querySelector("#figure-5 svg text");
  const ink = luminance(getComputedStyle(text).fill);
  const paper = luminance(getComputedStyle(document.body).backgroundColor);
  return (Math.max(ink, paper) + 0.05) / (Math.min(ink, paper) + 0.05);
}

for (const colorScheme of ["light", "dark"]) {
  test(`is readable and accessible on a ${colorScheme} page and on a phone`, async () => {
    const other = await open({ colorScheme, viewport: { width: 390, height: 800 } });
    assert.ok((await other.evaluate(contrast)) > 7);
    assert.deepEqual(await seriousFindings(other), []);
    const width = await other.evaluate(() => document.documentElement.scrollWidth);
    assert.ok(width <= 390, `the page is ${width} pixels wide`);
    await other.close();
  });
}

test("nothing is reported by the browser", () => assert.deepEqual(errors, []));
