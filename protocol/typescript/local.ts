// Images and servers by the program heliograph on this machine. For Node.

import { spawn } from "node:child_process";
import { accessSync, constants } from "node:fs";
import { delimiter, join, resolve } from "node:path";
import type { JobCreateParams } from "./messages.ts";

export class RenderError extends Error {}

/** An entry of a manifest, without its scene and its file. */
export type RenderEntry = Omit<JobCreateParams["entries"][number], "scene" | "output">;

export interface LocalServer {
  url: string;
  stop(): Promise<void>;
}

function isProgram(path: string): boolean {
  try {
    accessSync(path, constants.X_OK);
    return true;
  } catch {
    return false;
  }
}

/** The program of the variable HELIOGRAPH_BINARY, or the one in PATH. */
export function findProgram(): string {
  const named = process.env.HELIOGRAPH_BINARY;
  if (named) return named;
  const folders = (process.env.PATH ?? "").split(delimiter);
  const found = folders.map((folder) => join(folder, "heliograph")).find(isProgram);
  if (!found) throw new RenderError("there is no program heliograph: set HELIOGRAPH_BINARY to its path");
  return found;
}

function lastLine(text: string): string {
  const line = text.trim().split("\n").pop() ?? "";
  return line.replace(/^heliograph: /, "") || "the program failed without a word";
}

/** Renders a scene into a file: `await render("helmet.glb", "helmet.png", { width: 512 })`. No server is needed. */
export function render(scene: string, output: string, entry: Partial<RenderEntry> = {}): Promise<void> {
  const whole = { ...entry, scene: resolve(scene), output: resolve(output) };
  return new Promise((done, fail) => {
    const program = spawn(findProgram(), ["render", "--manifest", "-", "--progress", "none"], {
      stdio: ["pipe", "ignore", "pipe"],
    });
    let errors = "";
    program.stderr.setEncoding("utf8").on("data", (text: string) => (errors += text));
    program.on("error", fail);
    program.on("close", (code) => (code === 0 ? done() : fail(new RenderError(lastLine(errors)))));
    program.stdin.on("error", () => {}); // the exit code tells of it
    program.stdin.end(JSON.stringify([whole]));
  });
}

/** Starts a server of these folders. Its options are those of `heliograph serve`: { "max-viewers": 4 }. */
export function serve(roots: string[], options: Record<string, string | number> = {}): Promise<LocalServer> {
  const words = roots.flatMap((root) => ["--scene-root", root]);
  for (const [name, value] of Object.entries(options)) words.push(`--${name}`, String(value));
  return new Promise((done, fail) => {
    const program = spawn(findProgram(), ["serve", "--port", "0", ...words], { stdio: ["ignore", "pipe", "pipe"] });
    const ended = new Promise<void>((end) => program.on("close", () => end()));
    const stop = () => {
      program.kill();
      return ended;
    };
    let errors = "";
    program.stderr.setEncoding("utf8").on("data", (text: string) => (errors = (errors + text).slice(-4096)));
    program.on("error", fail);
    program.on("close", () => fail(new RenderError(lastLine(errors))));
    program.stdout.setEncoding("utf8").on("data", (text: string) => {
      const url = /^listening on (\S+)/m.exec(text)?.[1];
      if (url) done({ url, stop });
    });
  });
}
