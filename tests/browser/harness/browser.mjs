// A headless Chromium and pages that remember everything that went wrong in them.

import { join } from "node:path";
import { chromium } from "playwright-core";
import { chromiumPath, outputFolder } from "./environment.mjs";

export function launchBrowser() {
  return chromium.launch({
    executablePath: chromiumPath,
    args: [
      "--headless",
      "--no-sandbox",
      "--disable-gpu",
      "--disable-quic",
      "--no-first-run",
      "--disable-background-networking",
      "--disable-component-update",
      "--disable-sync",
    ],
  });
}

/** Opens the client, in a new context if none is given. `complaints` collects console errors, exceptions and CSP violations. */
export async function openViewer(browser, url, { context: given, ...options } = {}) {
  const context =
    given ??
    (await browser.newContext({
      viewport: { width: 1280, height: 720 },
      colorScheme: "dark",
      ...options,
    }));
  const page = await context.newPage();
  const complaints = [];
  page.on("console", (message) => {
    if (["error", "warning"].includes(message.type())) complaints.push(message.text());
  });
  page.on("pageerror", (error) => complaints.push(error.message));
  await page.exposeFunction("reportViolation", (text) => complaints.push(text));
  await page.addInitScript(() => {
    document.addEventListener("securitypolicyviolation", (event) => {
      window.reportViolation(`CSP: ${event.violatedDirective} ${event.blockedURI}`);
    });
  });
  const response = await page.goto(url);
  return { page, context, complaints, response };
}

/** Waits until the page is connected and a picture has been drawn. */
export async function firstPicture(page, timeout = 120_000) {
  await page.waitForSelector('#pill[data-state="live"]', { timeout });
  await page.waitForFunction(
    () =>
      document.querySelector("#notice").hidden &&
      /\d/.test(document.querySelector('[data-figure="picture"] dd').textContent),
    undefined,
    { timeout },
  );
}

/** Between two points of space, as arrays. */
export const distance = (a, b) => Math.hypot(...a.map((value, axis) => value - b[axis]));

/** Has a script run in the stream worker before its own. */
export function prepareWorker(context, source) {
  return context.addInitScript((prelude) => {
    const Native = window.Worker;
    window.Worker = class extends Native {
      constructor(url, options) {
        const own = String(url);
        const parts = [`{${prelude}}\nimportScripts(${JSON.stringify(own)});`];
        const blob = () => URL.createObjectURL(new Blob(parts, { type: "text/javascript" }));
        super(own.endsWith("/worker.js") ? blob() : url, options);
      }
    };
  }, source);
}

export async function openTab(page, name) {
  await page.locator(`#tab-${name}`).click();
}

/** Opens the tab that something in the panel stands in. */
export async function reveal(locator) {
  const tab = await locator
    .first()
    .evaluate((node) => node.closest("[data-tab]").dataset.tab);
  await openTab(locator.page(), tab);
}

/** The figure with this name as the performance section shows it. */
export function figure(page, name) {
  return page.locator(`[data-figure="${name}"] dd`).textContent();
}

/** Waits until no more pictures come: the view rests and is fully sampled, or nearly so. */
export async function settle(page, timeout = 60_000) {
  await page.waitForFunction(
    () => {
      const samples = document.querySelector('[data-figure="samples"] dd').textContent;
      const rate = document.querySelector('[data-figure="frame_rate"] dd').textContent;
      return rate === "at rest" || Number(samples) >= 16;
    },
    undefined,
    { timeout, polling: 250 },
  );
}

export async function dragPicture(page, from, to, steps = 12) {
  await page.mouse.move(from.x, from.y);
  await page.mouse.down();
  for (let step = 1; step <= steps; step += 1) {
    const part = step / steps;
    await page.mouse.move(from.x + (to.x - from.x) * part, from.y + (to.y - from.y) * part);
    await page.waitForTimeout(16);
  }
  await page.mouse.up();
}

export function screenshot(page, name) {
  return page.screenshot({ path: join(outputFolder, `${name}.png`) });
}

/** A screenshot of the picture alone, without the panel and the pill that lie over it. */
export async function pictureScreenshot(page, name) {
  const show = (visibility) =>
    page.evaluate((value) => {
      for (const id of ["panel", "pill", "toasts"]) {
        document.getElementById(id).style.visibility = value;
      }
    }, visibility);
  await show("hidden");
  const png = await screenshot(page, name);
  await show("");
  return png;
}

/** Calls until the result is truthy; throws with the last result otherwise. */
export async function eventually(read, what, timeout = 20_000) {
  const deadline = Date.now() + timeout;
  let last;
  while (Date.now() < deadline) {
    last = await read();
    if (last) return last;
    await new Promise((resolve) => setTimeout(resolve, 150));
  }
  throw new Error(`${what} did not happen within ${timeout / 1000} s (last: ${last})`);
}
