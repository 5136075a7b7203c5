// Starts and stops the real server and asks it things over HTTP, beside the browser.

import { spawn } from "node:child_process";
import { once } from "node:events";
import { sceneRoot, serverBinary } from "./environment.mjs";

const startTimeoutMs = 90_000;

export class Server {
  constructor(child, url) {
    this.child = child;
    this.url = url;
  }

  get port() {
    return Number(new URL(this.url).port);
  }

  /** Asks one method and returns its result; throws with the server's message. */
  async call(method, params = {}, session = "main") {
    const response = await fetch(new URL(`rpc?session=${session}`, this.url), {
      method: "POST",
      headers: { "content-type": "application/json" },
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
}

/** Port 0 takes any free one. Resolves when the server has printed its address. */
export function startServer(port = 0) {
  const child = spawn(
    serverBinary,
    ["serve", "--port", String(port), "--scene-root", sceneRoot],
    { stdio: ["ignore", "pipe", "pipe"] },
  );
  let output = "";
  return new Promise((resolve, reject) => {
    const fail = (reason) => {
      clearTimeout(timer);
      child.kill("SIGKILL");
      reject(new Error(`${reason}; it said:\n${output.slice(-3000)}`));
    };
    const timer = setTimeout(() => fail("the server did not say where it listens"), startTimeoutMs);
    const read = (chunk) => {
      output += chunk;
      const address = /listening on (http:\/\/\S+)/.exec(output);
      if (!address) return;
      clearTimeout(timer);
      resolve(new Server(child, address[1]));
    };
    child.stdout.on("data", read);
    child.stderr.on("data", read);
    child.on("error", (error) => fail(`the server could not be started: ${error.message}`));
    child.on("exit", (code) => fail(`the server ended with ${code}`));
  });
}
