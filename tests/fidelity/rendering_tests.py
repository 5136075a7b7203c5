#!/usr/bin/env python3
"""The comparison with a small set, rendered by the real program: HELIOGRAPH_BINARY."""

import json
import os
import subprocess
import sys
import unittest
from pathlib import Path

try:
    import numpy
    from PIL import Image
    from small_set import MODELS, SIZE, SmallSet, rgba, triangle
except ImportError as missing:
    print(f"skipped: {missing}")
    sys.exit(77)

BINARY = os.environ.get("HELIOGRAPH_BINARY")
if not BINARY:
    print("skipped: HELIOGRAPH_BINARY is not set")
    sys.exit(77)


class Rendering(SmallSet):
    def run_script(self, *options):
        return subprocess.run(
            [sys.executable, Path(__file__).with_name("fidelity.py"), BINARY, self.assets / "out",
             "--samples", "4", *options], check=False, text=True, capture_output=True,
            env={**os.environ, "HELIOGRAPH_TEST_ASSETS": str(self.assets)})

    def rendered(self, name):
        return numpy.asarray(Image.open(self.assets / "out" / f"{name}.png")).astype(int)

    def test_camera_and_environment(self):
        """The triangle's corners as projected by hand; the light of the image's middle is at +X."""
        views = ({"name": "front"},
                 {"name": "side", "orbit": {"theta": -90.0}, "renderSkybox": True},
                 {"name": "back", "orbit": {"theta": 90.0}, "renderSkybox": True})
        self.describe(*views)
        for view in ("front", "side", "back"):
            self.add_image(view, "vray", rgba((1, 2, 3)))
        self.run_script()
        rows, columns = numpy.nonzero(self.rendered("front")[..., 3] > 128)
        # 90 degrees at a distance of 2: half an image is 2 wide, a corner at 1 is at a quarter.
        for found, expected in ((rows.min(), 16), (rows.max(), 47), (columns.min(), 16),
                                (columns.max(), 47)):
            self.assertLessEqual(abs(int(found) - expected), 1)
        self.assertLessEqual(abs(columns[rows == rows.min()].mean() - 31.5), 1.0)
        self.assertGreater(self.rendered("side")[4, 32].min(), 200)
        self.assertLess(self.rendered("back")[4, 32].max(), 60)

    def test_whole_set(self):
        self.describe({"name": "khronos-A"},
                      {"name": "khronos-Missing", "model": MODELS + "B.gltf"})
        self.add_image("khronos-A", "vray", rgba((0, 0, 0), size=SIZE))
        self.add_image("khronos-A", "babylon", rgba((9, 0, 0), size=SIZE))
        run = self.run_script()
        self.assertEqual(run.returncode, 1, run.stdout + run.stderr)
        self.assertIn("silhouette", run.stdout)
        # Now both engines agree with what Heliograph has rendered.
        for engine in ("vray", "babylon"):
            self.add_image("khronos-A", engine, self.rendered("khronos-A").astype(numpy.uint8))
        run = self.run_script()
        self.assertEqual(run.returncode, 0, run.stdout + run.stderr)
        view = json.loads((self.assets / "out/fidelity.json").read_text())["views"][0]
        self.assertEqual((view["place_by_ssim"], view["place_by_flip"]), (1, 1))
        self.assertEqual(view["silhouette"], 0.0)
        self.assertEqual(view["kinds"], ["metal"])

    def test_a_model_that_is_broken_fails(self):
        self.describe({"name": "khronos-A"})
        self.add_image("khronos-A", "vray", rgba((0, 0, 0), size=SIZE))
        self.model.write_text(json.dumps({**triangle([1, 0, 0]), "accessors": []}))
        run = self.run_script()
        self.assertEqual(run.returncode, 1)
        self.assertIn("FAILED: ", run.stdout)

    def test_nothing_to_compare_with(self):
        run = self.run_script()
        self.assertEqual(run.returncode, 77)
        self.assertIn("skipped: ", run.stdout)
        self.describe({"name": "khronos-A"})
        self.assertEqual(self.run_script().returncode, 77)


if __name__ == "__main__":
    unittest.main()
