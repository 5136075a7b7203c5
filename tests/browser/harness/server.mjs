// Starts and stops the real server and asks it things over HTTP, beside the browser.

import { spawn } from "node:child_process";
import { once } from "node:events";
import { sceneRoot, serverBinary } from "./environment.mjs";

const startTimeoutMs = 180_000;
const keptOutput = 4000; // characters

export class Server {
  constructor(child) {
    this.child = child;
    this.url = "";
    this.lastWords = "";
    /** Headers that every call carries, such as a token's. */
    this.headers = {};
  }

  get port() {
    return Number(new URL(this.url).port);
  }

  /** Asks one method and returns its result; throws with the server's message. */
  async call(method, params = {}, session = "main") {
    const response = await fetch(new URL(`rpc?session=${session}`, this.url), {
      method: "POST",
      headers: { "content-type": "application/json", ...this.headers },
      body: JSON.stringify({ jsonrpc: "2.0", id: 1, method, params }),
    });
    const { result, error } = await response.json();
    if (error) throw new Error(`${method}: ${error.message}`);
    return result;
  }

  async setting(path) {
    const { settings } = await this.call("settings.get");
    return path.split(".").reduce((node, name) => node?.[name], settings);
  }

  async stop(signal = "SIGTERM") {
    if (this.child.exitCode !== null || this.child.signalCode !== null) return;
    const exited = once(this.child, "exit");
    this.child.kill(signal);
    const patience = setTimeout(() => this.child.kill("SIGKILL"), 10_000);
    await exited;
    clearTimeout(patience);
  }

  /** Takes what the process writes. */
  hear(chunk) {
    this.lastWords = (this.lastWords + chunk).slice(-keptOutput);
  }
}

/** The token in a list of arguments, as the header that shows it. */
function headersFor(args) {
  const token = args[args.indexOf("--token") + 1];
  return args.includes("--token") ? { authorization: `Bearer ${token}` } : {};
}

/** Port 0 takes any free one. Resolves when the server has printed its address. */
export function startServer(port = 0, args = []) {
  const child = spawn(
    serverBinary,
    ["serve", "--port", String(port), "--scene-root", sceneRoot, ...args],
    { stdio: ["ignore", "pipe", "pipe"] },
  );
  const server = new Server(child);
  server.headers = headersFor(args);
  return new Promise((resolve, reject) => {
    const fail = (reason) => {
      clearTimeout(timer);
      child.kill("SIGKILL");
      reject(new Error(`${reason}; it said:\n${server.lastWords}`));
    };
    const timer = setTimeout(() => fail("the server did not say where it listens"), startTimeoutMs);
    const read = (chunk) => {
      server.hear(chunk);
      if (server.url) return;
      const address = /listening on (http:\/\/\S+)\n/.exec(server.lastWords);
      if (!address) return;
      clearTimeout(timer);
      server.url = address[1];
      resolve(server);
    };
    child.stdout.on("data", read);
    child.stderr.on("data", read);
    child.on("error", (error) => fail(`the server could not be started: ${error.message}`));
    child.on("exit", (code) => fail(`the server ended with ${code}`));
  });
}
