"""The notebook among the examples runs from its first cell to its last."""

import json
import os
import subprocess
import sys
import unittest

from harness.server import Server

PROTOCOL = os.path.join(os.path.dirname(os.path.abspath(__file__)), "../../../protocol")
NOTEBOOK = os.path.join(PROTOCOL, "examples", "compare_presets.ipynb")


def code_of(path):
    with open(path, encoding="utf-8") as file:
        cells = json.load(file)["cells"]
    return ["".join(cell["source"]) for cell in cells if cell["cell_type"] == "code"]


class Notebook(unittest.TestCase):
    def test_has_no_outputs_of_its_author(self):
        with open(NOTEBOOK, encoding="utf-8") as file:
            cells = json.load(file)["cells"]
        self.assertEqual([cell.get("outputs", []) for cell in cells if cell.get("outputs")], [])

    def test_tells_whether_a_preset_is_better(self):
        try:
            import scipy  # noqa: F401
            import skimage  # noqa: F401
        except ImportError as missing:
            self.skipTest(str(missing))
        with Server("--scene", "mirror") as server:
            before = server.call("settings.get")["settings"]
            done = subprocess.run(
                [sys.executable, "-c", "\n".join(code_of(NOTEBOOK))], capture_output=True,
                text=True, timeout=120, env={
                    **os.environ, "PYTHONPATH": os.path.join(PROTOCOL, "python"),
                    "HELIOGRAPH_URL": f"http://{server.host}:{server.port}",
                    "HELIOGRAPH_SIZE": "64x36", "HELIOGRAPH_SAMPLES": "16"})
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertEqual(server.call("settings.get")["settings"], before)
            self.assertEqual(len(server.call("session.list")["sessions"]), 1)
        self.assertRegex(done.stdout, r"mine: SSIM 0\.\d{4}, by seed")
        self.assertRegex(done.stdout, r"mine - best: [+-]0\.\d{4}, p = \d\.\d{4}: the difference is")


if __name__ == "__main__":
    unittest.main()
