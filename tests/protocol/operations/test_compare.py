"""`heliograph compare`: scenes, presets, servers and image files."""

import os
import subprocess
import tempfile
import unittest

from harness.server import Server


class Compare(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name
        self.mirror, self.furnace = (os.path.join(os.environ["HELIOGRAPH_SCENES"], name + ".glb")
                                     for name in ("mirror", "furnace"))

    def compare(self, *arguments, size="64"):
        done = subprocess.run([os.environ["HELIOGRAPH_BINARY"], "compare", *arguments, "--width", size,
                               "--height", size, "--samples", "2"], cwd=self.folder, capture_output=True,
                              text=True, timeout=120, check=False)
        return done.returncode, done.stdout, done.stderr

    def test_scenes_and_their_report(self):
        status, told, _ = self.compare(self.mirror, self.mirror)
        self.assertEqual((status, told), (0, "main: SSIM 1.0000, FLIP 0.0000, largest difference 0: similar\n"))
        status, told, _ = self.compare(self.mirror, self.furnace, "--report", "report.html")
        self.assertEqual(status, 1, told)
        self.assertRegex(told, r"SSIM 0\.\d+, FLIP 0\.\d+, .*: differs")
        with open(os.path.join(self.folder, "report.html"), encoding="utf-8") as file:
            page = file.read()
        self.assertEqual(page.count("data:image/png;base64,"), 3)
        self.assertIn("mirror.glb", page)
        self.assertEqual(self.compare(self.mirror, self.furnace, "--ssim", "0")[0], 0)
        self.assertEqual(self.compare(self.mirror, self.furnace, "--ssim", "0", "--flip", "0.001")[0], 1)

    def test_presets_of_one_scene(self):
        status, told, _ = self.compare(self.mirror, "--preset", "svgf", "--second-preset", "best", "--ssim", "0")
        self.assertEqual(status, 0)
        self.assertNotIn("largest difference 0:", told)

    def test_a_server_and_an_image_file(self):
        with Server("--scene", "mirror") as server:
            path = "/api/v1/sessions/main/frame.png?width=64&height=64&samples=2"
            with open(os.path.join(self.folder, "kept.png"), "wb") as file:
                file.write(server.get(path)[2])
            status, told, errors = self.compare(server.url, "kept.png", "--ssim", "0.9")
        self.assertEqual(status, 0, told + errors)

    def test_what_cannot_be_compared(self):
        for arguments, reason in (((self.mirror,), "--second-preset"), ((self.mirror, "no.png"), "no.png"),
                                  ((self.mirror, "http://127.0.0.1:1"), "Connection refused"),
                                  ((self.mirror, "missing.glb"), "missing.glb")):
            status, _, errors = self.compare(*arguments)
            self.assertEqual(status, 2, errors)
            self.assertIn(reason, errors)
