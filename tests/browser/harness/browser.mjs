// A headless Chromium, pages that remember everything that went wrong in them, and what tests do
// with both.

import { join } from "node:path";
import { chromium } from "playwright-core";
import { chromiumPath, outputFolder } from "./environment.mjs";
import { observer } from "./observer.mjs";

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

/** Opens the client. `complaints` collects console errors, exceptions and CSP violations. */
export async function openViewer(context, url) {
  const page = await context.newPage();
  const complaints = [];
  page.on("console", (message) => {
    if (["error", "warning"].includes(message.type())) complaints.push(message.text());
  });
  page.on("pageerror", (error) => complaints.push(error.message));
  await page.exposeFunction("reportViolation", (text) => complaints.push(text));
  await page.addInitScript(observer);
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

/** Waits until the page shows the newest state of its session, final or nearly so. */
export async function settle(page, server, timeout = 120_000) {
  const { rev } = await server.call("session.info");
  await page.waitForFunction(
    (wanted) => {
      const { frame } = window.seen;
      return frame && frame.stateRev >= wanted && (frame.final || frame.samples >= 16);
    },
    rev,
    { timeout, polling: 100 },
  );
}

/** Moves the session's camera from outside and waits until the page has heard of it. */
export async function setCamera(page, server, pose) {
  const { eye } = await server.call("camera.set", pose);
  await page.waitForFunction(
    (wanted) => window.seen.camera?.eye.every((value, axis) => value === wanted[axis]),
    eye,
    { timeout: 30_000 },
  );
}

/** Waits until the page moves the camera no more and the server has its last pose. */
export async function restingCamera(page, server) {
  await page.evaluate(
    (quietFrames) =>
      new Promise((resolve) => {
        let [poses, quiet] = [-1, 0];
        const look = () => {
          quiet = window.seen.poses === poses ? quiet + 1 : 0;
          poses = window.seen.poses;
          if (quiet >= quietFrames) resolve();
          else requestAnimationFrame(look);
        };
        look();
      }),
    10,
  );
  return eventually(async () => {
    const camera = await server.call("camera.get");
    const pose = await page.evaluate(() => window.seen.pose);
    return (!pose || distance(camera.eye, pose.eye) < 1e-3) && camera;
  }, "the server to have the last pose");
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

/** Unfolds every section of the panel. */
export function unfoldAll(page) {
  return page.evaluate(() => {
    for (const fold of document.querySelectorAll(".section details")) fold.open = true;
  });
}

/** Opens the menu for saving and sharing and chooses an entry. */
export async function chooseOutput(page, name) {
  await page.getByRole("button", { name: "Save and share" }).click();
  await page.getByRole("menuitem", { name }).click();
}

/** The figure with this name as the performance section shows it. */
export function figure(page, name) {
  return page.locator(`[data-figure="${name}"] dd`).textContent();
}

/** The pauses are the hand's own: nothing is waited for. */
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
export async function eventually(read, what, timeout = 30_000) {
  const deadline = Date.now() + timeout;
  let last;
  do {
    last = await read();
    if (last) return last;
    await new Promise((resolve) => setTimeout(resolve, 100));
  } while (Date.now() < deadline);
  throw new Error(`${what} did not happen within ${timeout / 1000} s (last: ${last})`);
}
