// Controls Firefox by its remote protocol, Marionette (lengths and JSON over TCP): opens a page,
// runs scripts in it, takes screenshots, reads its errors.

import { spawn } from "node:child_process";
import { existsSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { connect } from "node:net";
import { tmpdir } from "node:os";
import { join } from "node:path";

const startTimeoutMs = 60_000;

const preferences = `
user_pref("marionette.port", 0);
user_pref("datareporting.policy.dataSubmissionEnabled", false);
user_pref("toolkit.telemetry.enabled", false);
user_pref("app.update.enabled", false);
user_pref("browser.shell.checkDefaultBrowser", false);
user_pref("browser.startup.homepage_override.mstone", "ignore");
user_pref("network.captive-portal-service.enabled", false);
user_pref("network.connectivity-service.enabled", false);
user_pref("extensions.getAddons.cache.enabled", false);
user_pref("services.settings.server", "");
`;

export class Firefox {
  constructor(child, socket, profile) {
    this.child = child;
    this.socket = socket;
    this.profile = profile;
    this.pending = new Map();
    this.lastId = 0;
    this.received = Buffer.alloc(0);
    socket.on("data", (chunk) => this.read(chunk));
  }

  static async launch(path) {
    const profile = mkdtempSync(join(tmpdir(), "heliograph-firefox-"));
    writeFileSync(join(profile, "user.js"), preferences);
    const args = ["--headless", "--marionette", "--remote-allow-system-access", "--no-remote"];
    args.push("--profile", profile);
    const child = spawn(path, args, { stdio: "ignore", env: { ...process.env, HOME: profile } });
    const port = await portOf(profile);
    const socket = connect(port, "127.0.0.1");
    await new Promise((resolve, reject) => socket.once("connect", resolve).once("error", reject));
    const firefox = new Firefox(child, socket, profile);
    await firefox.send("WebDriver:NewSession", { strictFileInteractability: true });
    await firefox.send("WebDriver:SetWindowRect", { width: 1000, height: 700 });
    return firefox;
  }

  open(url) {
    return this.send("WebDriver:Navigate", { url });
  }

  /** Runs a function body in the page and returns its result. */
  async evaluate(script, ...args) {
    const { value } = await this.send("WebDriver:ExecuteScript", { script, args });
    return value;
  }

  /**
   * Errors, warnings, exceptions and violations of the content security policy in pages of `url`.
   */
  async pageErrors(url) {
    await this.send("Marionette:SetContext", { value: "chrome" });
    try {
      return await this.evaluate(readPageErrors, url);
    } finally {
      await this.send("Marionette:SetContext", { value: "content" });
    }
  }

  async screenshot(path) {
    const { value } = await this.send("WebDriver:TakeScreenshot", { full: false });
    writeFileSync(path, Buffer.from(value, "base64"));
    return value;
  }

  async close() {
    await this.send("Marionette:Quit", { flags: ["eForceQuit"] }).catch(() => {});
    this.socket.destroy();
    this.child.kill("SIGKILL");
    rmSync(this.profile, { recursive: true, force: true, maxRetries: 5 });
  }

  send(command, parameters) {
    const id = ++this.lastId;
    const text = JSON.stringify([0, id, command, parameters]);
    this.socket.write(`${Buffer.byteLength(text)}:${text}`);
    return new Promise((resolve, reject) => this.pending.set(id, { resolve, reject }));
  }

  read(chunk) {
    this.received = Buffer.concat([this.received, chunk]);
    for (;;) {
      const colon = this.received.indexOf(":");
      if (colon < 0) return;
      const end = colon + 1 + Number(this.received.subarray(0, colon));
      if (this.received.length < end) return;
      const message = JSON.parse(this.received.subarray(colon + 1, end));
      this.received = this.received.subarray(end);
      if (Array.isArray(message)) this.onResponse(message); // the first message is a greeting
    }
  }

  onResponse([, id, error, result]) {
    const { resolve, reject } = this.pending.get(id);
    this.pending.delete(id);
    if (error) reject(new Error(error.message));
    else resolve(result);
  }
}

/** Runs in the browser's own context, which can read the errors of all pages. */
const readPageErrors = `
  const [url] = arguments;
  const messages = Services.console
    .getMessageArray()
    .filter((message) => message instanceof Ci.nsIScriptError && message.sourceName.startsWith(url))
    .map(({ errorMessage }) => errorMessage);
  const calls = Cc["@mozilla.org/consoleAPI-storage;1"]
    .getService(Ci.nsIConsoleAPIStorage)
    .getEvents()
    .filter(({ level, filename }) => ["error", "warn"].includes(level) && filename.startsWith(url))
    .map((call) => call.arguments.join(" "));
  return [...messages, ...calls];
`;

/** Reads the port from the file that Firefox writes. */
async function portOf(profile) {
  const file = join(profile, "MarionetteActivePort");
  const deadline = Date.now() + startTimeoutMs;
  while (Date.now() < deadline) {
    if (existsSync(file)) {
      const port = Number(readFileSync(file, "utf8"));
      if (port > 0) return port;
    }
    await new Promise((resolve) => setTimeout(resolve, 200));
  }
  throw new Error("Firefox did not write its port");
}
