// The server and the browser of a test file. Everything that a test opens is closed before the next
// one starts; after a failure the server is restarted, so that later tests are not affected.

import assert from "node:assert/strict";
import nodeTest, { after } from "node:test";
import { firstFrame, launchBrowser, openViewer, ownErrors, screenshot } from "./browser.mjs";
import { startServer } from "./server.mjs";

let browser = null; // all stages of a file share it
after(() => browser?.close());

export class Stage {
  /**
   * The server loads `scene`, unless it is null, and has `serverArguments`; a frame is converged after
   * `samples`, or the server's default if null. Pages ask for frames of this `resolution`, a third of
   * their own unless given: few pixels and samples take little time, which is enough where a test
   * does not look at the image. `view` has options of every page's context, `variables` some of the
   * server's environment. `prepare` runs once with the page that tests share.
   */
  constructor({
    scene = "shadow_objects",
    samples = 4,
    resolution = "third",
    serverArguments = [],
    view = {},
    variables = {},
    prepare = async () => {},
  } = {}) {
    this.serverArguments = [...serverArguments, ...(scene ? ["--scene", scene] : [])];
    /** Values of settings that are not the server's defaults. */
    this.settings = samples ? { "accumulation.max_samples": samples, "reference.samples": 2 } : {};
    for (const [path, value] of Object.entries(this.settings)) {
      this.serverArguments.push("--set", `${path}=${value}`);
    }
    this.samples = samples;
    this.resolution = resolution;
    this.view = view;
    this.variables = variables;
    this.prepare = prepare;
    this.contexts = new Set();
    this.viewers = [];
    this.shared = null;
    after(() => this.server?.stop());
  }

  /** Defines a test; `body` gets node's test context. */
  test(name, body) {
    nodeTest(name, async (t) => {
      let passed = false;
      try {
        await this.begin();
        await body(t);
        this.checkPageErrors();
        passed = true;
      } finally {
        await this.cleanUp(passed, name);
      }
    });
  }

  /**
   * A browser context that is closed after the test. The hint of a first visit, which covers a part
   * of the view, is shown with `firstVisit` only. `stored` are preferences of the page.
   */
  async context({ firstVisit = false, resolution = this.resolution, stored, ...options } = {}) {
    const context = await browser.newContext({
      viewport: { width: 960, height: 540 },
      colorScheme: "dark",
      ...this.view,
      ...options,
    });
    const preferences = { ...(firstVisit ? {} : { hint_seen: "1" }), resolution, ...stored };
    await context.addInitScript((values) => {
      // Without storage: about:blank, and what Firefox loads before the page.
      if (location.protocol === "about:" || window.origin === "null") return;
      for (const [name, value] of Object.entries(values)) {
        localStorage.setItem(`heliograph.${name}`, value);
      }
    }, preferences);
    this.contexts.add(context);
    return context;
  }

  /**
   * Opens the client in a new page, in a new context unless one is given. Errors of the page fail
   * the test, unless `expectErrors` is set.
   */
  async open({ url = this.server.url, context: given, expectErrors = false, ...options } = {}) {
    const context = given ?? (await this.context(options));
    const viewer = await openViewer(context, url);
    this.viewers.push({ ...viewer, expectErrors });
    return viewer;
  }

  /** Opens the client and waits for its first frame. */
  async watch(options) {
    const viewer = await this.open(options);
    await firstFrame(viewer.page);
    return viewer;
  }

  /** The page that the tests of a file share, with its first frame. */
  async sharedViewer() {
    if (!this.shared) {
      const viewer = await this.watch();
      await this.prepare(viewer.page);
      this.shared = viewer;
    }
    return this.shared;
  }

  /** Stops the server and starts another one at the same address. */
  async restartServer(args) {
    const { port } = this.server;
    await this.server.stop();
    this.server = await startServer(port, args, this.variables);
  }

  async begin() {
    browser ??= await launchBrowser();
    this.server ??= await startServer(0, this.serverArguments, this.variables);
  }

  checkPageErrors() {
    for (const { pageErrors, expectErrors } of this.viewers) {
      if (expectErrors) continue;
      assert.deepEqual(ownErrors(pageErrors), [], "the page reported errors");
    }
  }

  async cleanUp(passed, name) {
    if (!passed) await this.describeFailure(name);
    const kept = passed ? this.shared?.context : null;
    for (const context of [...this.contexts].filter((one) => one !== kept)) {
      this.contexts.delete(context);
      await context.close().catch(() => {});
    }
    this.viewers = this.viewers.filter(({ context }) => context === kept);
    if (passed) {
      await this.resetSessions();
      return;
    }
    this.shared = null;
    await this.server?.stop("SIGKILL");
    this.server = null;
  }

  /** Closes every session but main, and resets control of main. */
  async resetSessions() {
    const { sessions } = await this.server.call("session.list");
    for (const { name } of sessions.filter((one) => one.name !== "main")) {
      // Its last viewer may have closed it.
      await this.server.call("session.close", { session: name }).catch(() => {});
    }
    await this.server.call("session.control", { mode: "shared" });
  }

  async describeFailure(name) {
    const stem = `failed_${name.replace(/\W+/g, "_").slice(0, 60)}`;
    for (const [index, { page, pageErrors }] of this.viewers.entries()) {
      await screenshot(page, `${stem}_${index}`).catch(() => {});
      if (pageErrors.length > 0) console.log(`errors of page ${index}:`, pageErrors);
    }
    if (this.server) console.log(`last output of the server:\n${this.server.lastOutput}`);
  }
}
