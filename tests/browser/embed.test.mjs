// The viewer in pages of other origins (the copied code, the web component, what is not allowed) and
// in notebooks.

import assert from "node:assert/strict";
import { spawn, spawnSync } from "node:child_process";
import { readFileSync, writeFileSync } from "node:fs";
import { createServer } from "node:http";
import { dirname, join } from "node:path";
import { createInterface } from "node:readline";
import { fileURLToPath } from "node:url";
import { after } from "node:test";
import { seriousFindings } from "./harness/axe.mjs";
import { chooseOutput, dragView, eventually, screenshot } from "./harness/browser.mjs";
import { inFirefox, outputFolder } from "./harness/environment.mjs";
import { Stage } from "./harness/stage.mjs";

const guestView = { viewport: { width: 1000, height: 640 } };

/** A web server of another origin with one page; `script` is what it serves at /viewer.js. */
async function otherSite(html) {
  const site = { html: "", script: "" };
  const server = createServer((request, response) => {
    const asksForScript = request.url === "/viewer.js";
    response.setHeader("content-type", asksForScript ? "text/javascript" : "text/html");
    response.end(asksForScript ? site.script : html(site));
  });
  await new Promise((resolve) => server.listen(0, "127.0.0.1", resolve));
  site.origin = `http://127.0.0.1:${server.address().port}`;
  site.close = () => server.close();
  return site;
}

const page = ({ html }) => `<!doctype html><html lang="en"><title>Another site</title><h1>Embedded viewer</h1>${html}`;
const [allowed, other] = await Promise.all([otherSite(page), otherSite(page)]);
after(() => [allowed, other].forEach((site) => site.close()));
const embedded = new Stage({
  view: {
    viewport: { width: 720, height: 405 },
    permissions: ["clipboard-read", "clipboard-write"],
  },
  serverArguments: ["--frame-ancestors", allowed.origin],
});

async function copiedCode(kind) {
  const { page } = await embedded.sharedViewer();
  await chooseOutput(page, "Embed in another page");
  const dialog = page.getByRole("dialog", { name: "Embed" });
  await dialog.getByLabel("Kind").selectOption(kind);
  await screenshot(page, `embed_${kind}`);
  assert.deepEqual(await seriousFindings(page), []);
  await dialog.getByRole("button", { name: "Copy" }).click();
  await dialog.waitFor({ state: "hidden" });
  const code = await page.evaluate(() => navigator.clipboard.readText());
  writeFileSync(join(outputFolder, `embed_${kind}.html`), code);
  return code;
}

/** An orbit by keyboard in the embedded page changes its own session, not the shared one. */
async function orbitsItsOwnSession(guest) {
  const frame = guest.frames()[1];
  await frame.locator("#view").focus();
  const cameraOf = (session) => embedded.server.call("camera.get", {}, session);
  const { sessions } = await embedded.server.call("session.list");
  const own = sessions.find(({ name, viewers }) => name !== "main" && viewers.length > 0).name;
  const [{ eye }, shared] = [await cameraOf(own), await cameraOf("main")];
  await guest.keyboard.press("ArrowLeft", { delay: 100 });
  await eventually(
    async () => String((await cameraOf(own)).eye) !== String(eye),
    "an orbit in the embedded page",
  );
  assert.deepEqual(await cameraOf("main"), shared, "the page that embeds changed the shared view");
}

embedded.test("the copied frame shows the viewer in allowed origins only", async () => {
  const code = await copiedCode("frame");
  assert.match(code, /^<iframe/);
  allowed.html = other.html = code;
  const guest = await (await embedded.context(guestView)).newPage();
  await guest.goto(allowed.origin);
  const inside = guest.frameLocator("iframe");
  await inside.locator('#pill[data-state="live"]').waitFor({ timeout: 60_000 });
  await inside.locator("#notice").waitFor({ state: "hidden", timeout: 60_000 });
  await screenshot(guest, "embedded");
  await orbitsItsOwnSession(guest);

  const rejected = await (await embedded.context()).newPage();
  const violations = [];
  rejected.on("console", (message) => violations.push(message.text()));
  await rejected.goto(other.origin);
  // Firefox tells it to its user only.
  if (!inFirefox) {
    await eventually(
      () => violations.some((text) => text.includes("frame-ancestors")),
      "a rejection by the content security policy",
    );
  }
  assert.equal(await rejected.frameLocator("iframe").locator("#view").count(), 0);
});

embedded.test("the web component shows the view that was copied, and tells its page", async () => {
  const code = await copiedCode("component");
  assert.match(code, /<heliograph-viewer src="[^"]+" model="shadow_objects" view="view=/);
  allowed.html = `${code}<p id="told"></p><script>
    document.querySelector("heliograph-viewer").addEventListener("ready", () => {
      document.querySelector("#told").textContent = "the viewer is ready";
    });
  </script>`;
  const guest = await (await embedded.context(guestView)).newPage();
  const messages = [];
  guest.on("console", (message) => messages.push(message.text()));
  await guest.goto(allowed.origin);
  await guest.getByText("the viewer is ready").waitFor({ timeout: 60_000 });
  await screenshot(guest, "embedded_component");
  await orbitsItsOwnSession(guest);
  // Another model is shown without loading the page again.
  await guest.evaluate(() => {
    const viewer = document.querySelector("heliograph-viewer");
    viewer.removeAttribute("view");
    viewer.setAttribute("model", "mirror");
  });
  await eventually(async () => (await guest.frames()[1].title()).startsWith("mirror"), "the model");
  assert.deepEqual(messages, []);
  assert.deepEqual(await seriousFindings(guest), []);
});

embedded.test("the web component says when a server does not allow its page", async () => {
  const module = await fetch(new URL("heliograph-viewer.js", embedded.server.url));
  other.script = await module.text();
  const server = embedded.server.url;
  other.html =
    `<script type="module" src="viewer.js"></script>` +
    `<heliograph-viewer src="${server}" model="mirror"><em>A drawing</em></heliograph-viewer>`;
  const guest = await (await embedded.context(guestView)).newPage();
  await guest.clock.install();
  await guest.goto(other.origin);
  await guest.getByText("A drawing").waitFor();
  await guest.locator("heliograph-viewer iframe").waitFor({ state: "attached" });
  await guest.clock.fastForward(16_000);
  const message = guest.getByRole("alert");
  await message.getByText(/does not answer, or does not allow this page/).waitFor();
  await screenshot(guest, "embedded_failed");
  // Nor may other origins load the module from the server.
  const refused = await fetch(new URL("heliograph-viewer.js", server), {
    headers: { origin: other.origin },
  });
  assert.equal(refused.status, 403);
});

const here = dirname(fileURLToPath(import.meta.url));
const library = join(here, "../../protocol/python");
const python = "/usr/bin/python3";

embedded.test("the notebook's module shows frames and moves the camera", async (t) => {
  if (spawnSync(python, ["-c", "import websockets"]).status !== 0) {
    t.skip("python3-websockets is not installed");
    return;
  }
  const script = join(here, "harness/notebook_kernel.py");
  const kernel = spawn(python, [script, embedded.server.url], {
    env: { ...process.env, PYTHONPATH: library },
    stdio: ["pipe", "pipe", "inherit"],
  });
  t.after(() => kernel.kill());
  const notebook = await (await embedded.context(guestView)).newPage();
  await notebook.exposeFunction("toKernel", (text) => kernel.stdin.write(`${text}\n`));
  allowed.script = readFileSync(join(library, "heliograph/notebook.js"), "utf8");
  allowed.html = `<main id="cell"></main><script type="module">
    import widget from "./viewer.js";
    const traits = { session: "main", frame: new DataView(new ArrayBuffer(0)) };
    let changed = () => {};
    const model = {
      get: (name) => traits[name],
      on: (event, callback) => (changed = callback),
      off: () => (changed = () => {}),
      send: (message) => window.toKernel(JSON.stringify(message)),
    };
    window.fromKernel = (base64) => {
      const bytes = Uint8Array.from(atob(base64), (letter) => letter.charCodeAt(0));
      traits.frame = new DataView(bytes.buffer);
      changed();
    };
    window.close = widget.render({ model, el: document.querySelector("#cell") });
    window.loaded = true;
  </script>`;
  await notebook.goto(allowed.origin);
  await notebook.waitForFunction(() => window.loaded);
  createInterface({ input: kernel.stdout }).on("line", (base64) => {
    void notebook.evaluate((text) => window.fromKernel(text), base64).catch(() => {});
  });
  const image = notebook.getByRole("img", { name: "Rendered scene of the session main" });
  await notebook.waitForFunction(() => document.querySelector("#cell img").naturalWidth > 0);
  await screenshot(notebook, "notebook");
  assert.deepEqual(await seriousFindings(notebook), []);
  const eye = async () => String((await embedded.server.call("camera.get")).eye);
  const moves = async (action, what) => {
    const before = await eye();
    await action();
    await eventually(async () => (await eye()) !== before, what);
  };
  const { x, y } = await image.boundingBox();
  await moves(() => dragView(notebook, { x: x + 60, y: y + 60 }, { x: x + 160, y: y + 80 }), "a drag");
  await image.focus();
  await moves(() => notebook.keyboard.press("ArrowLeft"), "an arrow key");
  await moves(() => notebook.mouse.wheel(0, 120), "the wheel");
  await moves(() => notebook.keyboard.press("f"), "fitting");
});
