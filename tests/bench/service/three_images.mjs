// Renders models with three.js in a headless Chromium. Prints the seconds of each image as JSON.

import { performance } from "node:perf_hooks";

const { chromium } = await import(process.env.PLAYWRIGHT);
const work = JSON.parse(process.argv[2]);
const started = performance.now();
const browser = await chromium.launch({
  executablePath: work.browser,
  args: ["--headless", "--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"],
});
const page = await browser.newPage();
page.on("pageerror", (error) => console.error(error.message));
await page.goto(new URL("page/three_page.html", work.base).href);
await page.waitForFunction(() => typeof window.renderView === "function");
const seconds = [];
for (const model of work.models) {
  for (const [index, view] of work.views.entries()) {
    // With "cold" the start of the browser counts.
    const before = work.cold ? started : performance.now();
    const url = new URL(`models${encodeURI(model)}`, work.base).href;
    const image = await page.evaluate((args) => window.renderView(...args), [
      index === 0 ? url : null,
      view,
      work.size,
    ]);
    if (image === null) continue; // three.js does not read this model
    if (!image.startsWith("data:image/png")) throw new Error("no image");
    seconds.push((performance.now() - before) / 1000);
  }
}
await browser.close();
console.log(JSON.stringify(seconds));
