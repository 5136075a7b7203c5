#!/usr/bin/env node
// npx heliograph-client render helmet.glb -o helmet.png: runs the program heliograph.

import { spawn } from "node:child_process";
import { findProgram } from "./local.ts";

try {
  const program = spawn(findProgram(), process.argv.slice(2), { stdio: "inherit" });
  program.on("exit", (code) => process.exit(code ?? 1));
} catch (error) {
  console.error(`heliograph-client: ${(error as Error).message}`);
  process.exit(1);
}
