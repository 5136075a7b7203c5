// Starts and stops the server, and calls its methods over HTTP.

import { spawn } from "node:child_process";
import { once } from "node:events";
import { sceneRoot, serverBinary } from "./environment.mjs";

const startTimeoutMs = 180_000;
const maxOutput = 4000; // characters

export class Server {
  constructor(child) {
    this.child = child;
    this.url = "";
    this.lastOutput = "";
    /** Headers of every call, such as authorization. */
    this.headers = {};
  }

  get port() {
    return Number(new URL(this.url).port);
  }

  /** Calls a method and returns its result; throws with the server's message. */
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
    const killTimer = setTimeout(() => this.child.kill("SIGKILL"), 10_000);
    await exited;
    clearTimeout(killTimer);
  }

  /** Records the output of the process. */
  onOutput(chunk) {
    this.lastOutput = (this.lastOutput + chunk).slice(-maxOutput);
  }
}

/** The authorization header for the token in the arguments. */
function headersFor(args) {
  const token = args[args.indexOf("--token") + 1];
  return args.includes("--token") ? { authorization: `Bearer ${token}` } : {};
}

/**
 * Port 0 selects a free port. The scenes are those of the tests unless `args` names others;
 * `variables` are added to the environment. Resolves when the server has printed its URL.
 */
export function startServer(port = 0, args = [], variables = {}) {
  const roots = args.includes("--scene-root") ? [] : ["--scene-root", sceneRoot];
  const child = spawn(
    serverBinary,
    ["serve", "--port", String(port), ...roots, ...args],
    { stdio: ["ignore", "pipe", "pipe"], env: { ...process.env, ...variables } },
  );
  const server = new Server(child);
  server.headers = headersFor(args);
  return new Promise((resolve, reject) => {
    const fail = (reason) => {
      clearTimeout(timer);
      child.kill("SIGKILL");
      reject(new Error(`${reason}; its output:\n${server.lastOutput}`));
    };
    const timer = setTimeout(() => fail("the server did not print its URL"), startTimeoutMs);
    const read = (chunk) => {
      server.onOutput(chunk);
      if (server.url) return;
      const match = /listening on (http:\/\/\S+)\n/.exec(server.lastOutput);
      if (!match) return;
      clearTimeout(timer);
      server.url = match[1];
      resolve(server);
    };
    child.stdout.on("data", read);
    child.stderr.on("data", read);
    child.on("error", (error) => fail(`the server could not be started: ${error.message}`));
    child.on("exit", (code) => fail(`the server ended with ${code}`));
  });
}
