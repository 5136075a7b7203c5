// Settings of the tests from environment variables.

import { mkdirSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";

export const chromiumPath = process.env.HELIOGRAPH_CHROMIUM ?? "/usr/bin/chromium";
export const serverBinary = process.env.HELIOGRAPH_BINARY;
export const sceneRoot = process.env.HELIOGRAPH_SCENE_ROOT;

export const outputFolder =
  process.env.HELIOGRAPH_TEST_OUTPUT ?? join(tmpdir(), "heliograph-browser-tests");
mkdirSync(outputFolder, { recursive: true });
