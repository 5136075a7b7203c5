"""The npm package: compiled, packed, installed into an empty project, and used there. Skipped with a message if a
package is missing."""

import glob
import os
import shutil
import subprocess
import tempfile
import unittest

ROOT = os.path.normpath(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", ".."))
LIBRARY = os.path.join(ROOT, "protocol", "typescript")
TOOLS = os.path.join(ROOT, "web_client", "node_modules")

USE = """
import { render, RenderError, serve } from "heliograph-client";
import { HeliographClient } from "heliograph-client/client";
const scenes = process.env.HELIOGRAPH_SCENES;
await render(`${scenes}/mirror.glb`, "still.png", { width: 48, samples: 1 });
const failed = await render("missing.glb", "a.png").catch((error) => error);
if (!(failed instanceof RenderError) || !failed.message.includes("missing.glb")) throw failed;
const server = await serve([scenes], { scene: "mirror", width: 48, height: 32 });
const answer = await fetch(server.url + "health/ready");
await server.stop();
console.log(answer.status, typeof HeliographClient.connect);
"""
TYPED = """
import { render } from "heliograph-client";
const done: Promise<void> = render("a.glb", "a.png", { width: 48 });
// @ts-expect-error: there is no such member
render("a.glb", "a.png", { widht: 48 });
export default done;
"""


class NpmPackage(unittest.TestCase):
    def run_in(self, folder, *command):
        done = subprocess.run(command, cwd=folder, capture_output=True, text=True, timeout=120, check=False)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        return done.stdout

    def test_in_an_empty_project(self):
        if not shutil.which("npm") or not os.path.isdir(os.path.join(TOOLS, "typescript")):
            self.skipTest("npm or its package typescript is not installed")
        compiler = os.path.join(TOOLS, "typescript", "bin", "tsc")
        with tempfile.TemporaryDirectory() as folder:
            source, project = os.path.join(folder, "source"), os.path.join(folder, "project")
            shutil.copytree(LIBRARY, source)
            os.symlink(TOOLS, os.path.join(source, "node_modules"))
            self.run_in(source, "node", compiler, "--project", "tsconfig.json")
            self.run_in(source, "npm", "pack", "--ignore-scripts", "--pack-destination", folder)
            (archive,) = glob.glob(os.path.join(folder, "*.tgz"))
            os.mkdir(project)
            self.run_in(project, "npm", "init", "--yes")
            self.run_in(project, "npm", "install", "--offline", "--no-audit", archive)
            for name, text in (("use.mjs", USE), ("typed.mts", TYPED)):
                with open(os.path.join(project, name), "w", encoding="utf-8") as file:
                    file.write(text)
            self.assertEqual(self.run_in(project, "node", "use.mjs").strip(), "200 function")
            self.assertTrue(os.path.exists(os.path.join(project, "still.png")))
            self.run_in(project, "node", compiler, "--noEmit", "--strict", "--module", "nodenext", "typed.mts")
            self.assertIn("heliograph 0.", self.run_in(project, "npx", "heliograph-client", "--version"))


if __name__ == "__main__":
    unittest.main()
