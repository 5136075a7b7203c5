// A headless Chromium, pages that record errors, and helpers of the tests.

import { join } from "node:path";
import { chromium, firefox } from "playwright-core";
import {
  chromiumPath,
  downloadFolder,
  firefoxPath,
  inFirefox,
  outputFolder,
} from "./environment.mjs";
import { observer } from "./observer.mjs";

const launchOptions = {
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
};

/** A browser that test files use one after the other. */
export const startBrowserServer = () => chromium.launchServer(launchOptions);

/** Without a display it has no WebGL. */
function launchFirefox() {
  return firefox.launch({
    channel: "moz-firefox",
    executablePath: firefoxPath,
    headless: !process.env.DISPLAY,
    downloadsPath: downloadFolder,
    firefoxUserPrefs: {
      "webgl.force-enabled": true, // also by a software driver
      "dom.events.testing.asyncClipboard": true, // its driver grants no permissions
      "browser.download.alwaysOpenPanel": false, // it takes the focus from the page
    },
  });
}

/** The browser that HELIOGRAPH_TEST_BROWSER gives the address of, or a new one. */
export function launchBrowser() {
  if (inFirefox) return launchFirefox();
  const address = process.env.HELIOGRAPH_TEST_BROWSER;
  return address ? chromium.connect(address) : chromium.launch(launchOptions);
}

/** Opens the client. `pageErrors` collects console errors, exceptions and CSP violations. */
export async function openViewer(context, url) {
  const page = await context.newPage();
  const pageErrors = [];
  page.on("console", (message) => {
    if (["error", "warning"].includes(message.type())) pageErrors.push(message.text());
  });
  page.on("pageerror", (error) => pageErrors.push(error.message));
  await page.exposeFunction("reportViolation", (text) => pageErrors.push(text));
  await page.addInitScript(observer);
  await page.addInitScript(() => {
    document.addEventListener("securitypolicyviolation", (event) => {
      window.reportViolation(`CSP: ${event.violatedDirective} ${event.blockedURI}`);
    });
  });
  const response = await page.goto(url);
  return { page, context, pageErrors, response };
}

/** Of "body {}", a style that Playwright adds to Firefox's pages before a screenshot. */
const driverStyle = "sha256-YjaKGiklmzC6wjXA513HAMmzus8VE61XCOT+SmwNZWA=";

/**
 * What the page itself has reported: not the violations that Playwright's style is, each of which
 * comes as an event and as a message with the style's hash.
 */
export function ownErrors(pageErrors) {
  const isDriver = (text) => text.includes(driverStyle);
  let events = pageErrors.filter(isDriver).length;
  return pageErrors.filter((text) => {
    if (isDriver(text)) return false;
    return text !== "CSP: style-src-elem inline" || --events < 0;
  });
}

/** Waits until the page is connected and has drawn a frame. */
export async function firstFrame(page, timeout = 120_000) {
  await page.waitForSelector('#pill[data-state="live"]', { timeout });
  await page.waitForFunction(
    () =>
      document.querySelector("#notice").hidden &&
      /\d/.test(document.querySelector('[data-figure="frame_size"] dd').textContent),
    undefined,
    { timeout },
  );
}

/** Waits until the page shows the newest state of its session, converged or nearly so. */
export async function settle(page, server, timeout = 120_000) {
  const { rev } = await server.call("session.info");
  await page.waitForFunction(
    (minimum) => {
      const { frame } = window.seen;
      return frame && frame.stateRev >= minimum && (frame.final || frame.samples >= 16);
    },
    rev,
    { timeout, polling: 100 },
  );
}

/** Moves the session's camera from outside and waits until the page was notified. */
export async function setCamera(page, server, pose) {
  const { eye } = await server.call("camera.set", pose);
  await page.waitForFunction(
    (expected) => window.seen.camera?.eye.every((value, axis) => value === expected[axis]),
    eye,
    { timeout: 30_000 },
  );
}

/** Waits until the page has stopped the camera and the server has its last pose. */
export async function staticCamera(page, server) {
  await page.evaluate(
    (staticFrames) =>
      new Promise((resolve) => {
        let [poses, unchanged] = [-1, 0];
        const check = () => {
          const { cameraCalls } = window.seen;
          unchanged = window.seen.poses === poses && cameraCalls === 0 ? unchanged + 1 : 0;
          poses = window.seen.poses;
          if (unchanged >= staticFrames) resolve();
          else requestAnimationFrame(check);
        };
        check();
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

/** Runs a script in the stream worker before its own. */
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

/** Opens the tab that contains an element of the panel. */
export async function reveal(locator) {
  const tab = await locator.first().evaluate((node) => {
    const page = node.closest("[data-tab]");
    return page.hidden ? page.dataset.tab : null;
  });
  if (tab) await openTab(locator.page(), tab);
}

/** Opens every section of the panel. */
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

/** A figure of the Timing tab, by its name. */
export function figure(page, name) {
  return page.locator(`[data-figure="${name}"] dd`).textContent();
}

/** Pauses between the steps, like a real drag. */
export async function dragView(page, from, to, steps = 12) {
  await page.mouse.move(from.x, from.y);
  await page.mouse.down();
  for (let step = 1; step <= steps; step += 1) {
    const t = step / steps;
    await page.mouse.move(from.x + (to.x - from.x) * t, from.y + (to.y - from.y) * t);
    await page.waitForTimeout(16);
  }
  await page.mouse.up();
}

/** At a point of the window. Firefox's driver counts each click as a first one: the event follows. */
export async function doubleClick(page, at) {
  await page.mouse.dblclick(at.x, at.y);
  if (!inFirefox) return;
  await page.evaluate(({ x, y }) => {
    const event = new MouseEvent("dblclick", { bubbles: true, clientX: x, clientY: y });
    document.elementFromPoint(x, y).dispatchEvent(event);
  }, at);
}

export function screenshot(page, name) {
  // Playwright hides the caret by a style that Firefox reports as a violation.
  const caret = inFirefox ? "initial" : "hide";
  return page.screenshot({ path: join(outputFolder, `${name}.png`), caret });
}

/** A screenshot of the view, without panel, pill and toasts. */
export async function viewScreenshot(page, name) {
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
  let [last, pause] = [null, 10];
  do {
    last = await read();
    if (last) return last;
    await new Promise((resolve) => setTimeout(resolve, pause));
    pause = Math.min(100, 1.5 * pause);
  } while (Date.now() < deadline);
  throw new Error(`${what} did not happen within ${timeout / 1000} s (last: ${last})`);
}
