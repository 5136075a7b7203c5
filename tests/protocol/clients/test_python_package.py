"""The Python package: built as a wheel, installed into an environment of its own, and used there."""

import glob
import os
import shutil
import subprocess
import sys
import tempfile
import unittest

ROOT = os.path.normpath(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", ".."))
PACKAGE = os.path.join(ROOT, "protocol", "python")

USE = """
import os, heliograph
scene = os.path.join(os.environ["HELIOGRAPH_SCENES"], "mirror.glb")
heliograph.render(scene, "still.png", width=48, samples=1)
with heliograph.serve(os.environ["HELIOGRAPH_SCENES"], options={"scene": "mirror", "width": 48, "height": 32,
                                                                "jobs": "jobs"}) as url:
    heliograph.render("mirror", "job.png", url=url, width=48, samples=1)
    with heliograph.connect(url) as view:
        view.capture(samples=1).save("view.png")
for call, saying in ((lambda: heliograph.render("missing.glb", "a.png"), "missing.glb"),
                     (lambda: heliograph.render(scene, "a.png", widht=3), "mean width"),
                     (lambda: heliograph.render("mirror", "a.png", url=url), "no server at")):
    try:
        call()
        raise SystemExit("nothing was raised: " + saying)
    except heliograph.RenderError as error:
        assert saying in str(error), error
print(heliograph.__file__)
"""


class PythonPackage(unittest.TestCase):
    def test_a_wheel_is_all_that_is_needed(self):
        with tempfile.TemporaryDirectory() as folder:
            # A build leaves files beside the sources.
            source = os.path.join(folder, "source")
            shutil.copytree(PACKAGE, source, ignore=shutil.ignore_patterns("__pycache__"))
            built = subprocess.run(
                [sys.executable, "-m", "pip", "wheel", "--quiet", "--no-deps", "--no-build-isolation",
                 "--wheel-dir", folder, source], capture_output=True, text=True, check=False)
            if "No module named" in built.stderr:
                self.skipTest(built.stderr.strip().splitlines()[-1])
            self.assertEqual(built.returncode, 0, built.stderr)
            (wheel,) = glob.glob(os.path.join(folder, "heliograph-*.whl"))
            target = os.path.join(folder, "installed")
            subprocess.run([sys.executable, "-m", "pip", "install", "--quiet", "--no-deps", "--no-index", "--target",
                            target, wheel], capture_output=True, check=True)
            self.assertTrue(os.path.exists(os.path.join(target, "heliograph", "py.typed")))
            used = subprocess.run([sys.executable, "-c", USE], cwd=folder, capture_output=True, text=True, check=False,
                                  env={**os.environ, "PYTHONPATH": target}, timeout=120)
            self.assertEqual(used.returncode, 0, used.stderr)
            self.assertTrue(used.stdout.strip().startswith(target))
            for name in ("still.png", "job.png", "view.png"):
                with open(os.path.join(folder, name), "rb") as file:
                    self.assertEqual(file.read(4), b"\x89PNG", name)


if __name__ == "__main__":
    unittest.main()
