// The server and the browser of one file of tests. Whatever a test opens is closed before the next
// begins; after one that failed the server is another, so that one failure stays one.

import assert from "node:assert/strict";
import nodeTest, { after } from "node:test";
import { firstPicture, launchBrowser, openViewer, screenshot } from "./browser.mjs";
import { startServer } from "./server.mjs";

let browser = null; // all stages of a file share it
after(() => browser?.close());

export class Stage {
  /**
   * The server begins with `scene` and has `serverArguments`; a picture is finished after so many
   * `samples`, or as many as by default where it is null. `view` are options of every page's context. `prepare` is run once with the page that tests share.
   */
  constructor({
    scene = "shadow_objects",
    samples = 16,
    serverArguments = [],
    view = {},
    prepare = async () => {},
  } = {}) {
    this.serverArguments = [...serverArguments, "--scene", scene];
    if (samples) this.serverArguments.push("--set", `accumulation.max_samples=${samples}`);
    this.samples = samples;
    this.view = view;
    this.prepare = prepare;
    this.contexts = new Set();
    this.viewers = [];
    this.shared = null;
    after(() => this.server?.stop());
  }

  /** A test of its own name; `body` gets node's test context. */
  test(name, body) {
    nodeTest(name, async (t) => {
      let passed = false;
      try {
        await this.begin();
        await body(t);
        this.checkComplaints();
        passed = true;
      } finally {
        await this.tidy(passed, name);
      }
    });
  }

  /** A context of the browser that ends with the test. */
  async context(options = {}) {
    const context = await browser.newContext({
      viewport: { width: 960, height: 540 },
      colorScheme: "dark",
      ...this.view,
      ...options,
    });
    this.contexts.add(context);
    return context;
  }

  /**
   * Opens the client in a page of its own, in a new context unless one is given. Complaints of the
   * page fail the test, unless `complaining` says that there will be some.
   */
  async open({ url = this.server.url, context: given, complaining = false, ...options } = {}) {
    const context = given ?? (await this.context(options));
    const viewer = await openViewer(context, url);
    this.viewers.push({ ...viewer, complaining });
    return viewer;
  }

  /** Opens the client and waits for its first picture. */
  async watch(options) {
    const viewer = await this.open(options);
    await firstPicture(viewer.page);
    return viewer;
  }

  /** The page that the tests of a file go through one after another, with its first picture. */
  async sharedViewer() {
    if (!this.shared) {
      const viewer = await this.watch();
      await this.prepare(viewer.page);
      this.shared = viewer;
    }
    return this.shared;
  }

  /** Whether the server has a method; skips the test where it has not. */
  async lacks(t, method) {
    const { methods } = await this.server.call("rpc.discover");
    const lacks = !methods.some(({ name }) => name === method);
    if (lacks) t.skip(`the server has no ${method}`);
    return lacks;
  }

  /** Stops the server and starts another one at the same address. */
  async restartServer(args) {
    const { port } = this.server;
    await this.server.stop();
    this.server = await startServer(port, args);
  }

  async begin() {
    browser ??= await launchBrowser();
    this.server ??= await startServer(0, this.serverArguments);
  }

  checkComplaints() {
    for (const { complaints, complaining } of this.viewers) {
      if (!complaining) assert.deepEqual(complaints, [], "the page complained");
    }
  }

  async tidy(passed, name) {
    if (!passed) await this.describeFailure(name);
    const stays = passed ? this.shared?.context : null;
    for (const context of [...this.contexts].filter((one) => one !== stays)) {
      this.contexts.delete(context);
      await context.close().catch(() => {});
    }
    this.viewers = this.viewers.filter(({ context }) => context === stays);
    if (passed) {
      await this.leaveMainAlone();
      return;
    }
    this.shared = null;
    await this.server?.stop("SIGKILL");
    this.server = null;
  }

  /** Ends every session but main, and gives main back to everyone. */
  async leaveMainAlone() {
    const { sessions } = await this.server.call("session.list");
    for (const { name } of sessions.filter((one) => one.name !== "main")) {
      // It may have been closed by its last viewer in this moment.
      await this.server.call("session.close", { session: name }).catch(() => {});
    }
    await this.server.call("session.control", { mode: "shared" });
  }

  async describeFailure(name) {
    const stem = `failed_${name.replace(/\W+/g, "_").slice(0, 60)}`;
    for (const [index, { page, complaints }] of this.viewers.entries()) {
      await screenshot(page, `${stem}_${index}`).catch(() => {});
      if (complaints.length > 0) console.log(`page ${index} complained:`, complaints);
    }
    if (this.server) console.log(`the server said at last:\n${this.server.lastWords}`);
  }
}
