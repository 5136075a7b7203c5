// Settings of the tests from environment variables.

import { existsSync, mkdirSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";

export const chromiumPath = process.env.HELIOGRAPH_CHROMIUM ?? "/usr/bin/chromium";
export const firefoxPath =
  process.env.HELIOGRAPH_FIREFOX ??
  ["/usr/bin/firefox-esr", "/usr/bin/firefox"].find((path) => existsSync(path));
/** Whether tests run in Firefox instead of Chromium. */
export const inFirefox = process.env.HELIOGRAPH_TEST_BROWSER === "firefox";
export const serverBinary = process.env.HELIOGRAPH_BINARY;
export const sceneRoot = process.env.HELIOGRAPH_SCENE_ROOT;

export const outputFolder =
  process.env.HELIOGRAPH_TEST_OUTPUT ?? join(tmpdir(), "heliograph-browser-tests");
mkdirSync(outputFolder, { recursive: true });

/** Where the Firefox of this process saves files. */
export const downloadFolder = join(tmpdir(), `heliograph-downloads-${process.pid}`);
