"""A view that has come to rest gets better with every sample, in six scenes as they open."""

import base64
import os
import unittest
from pathlib import Path

from harness.images import decode_png
from harness.server import Server

try:
    import numpy
    from skimage.metrics import structural_similarity
except ImportError:
    numpy = None

ASSETS = Path(os.environ.get("HELIOGRAPH_TEST_ASSETS", "/nonexistent")) / "gltf"
# Rooms, of which one is lit by a small surface; models in the studio; lights of the file.
SCENES = ("CornellBox", "room_godot", "DamagedHelmet", "FlightHelmet/FlightHelmet", "house",
          "Lights")
MOVED_FRAMES = 12
SAMPLES = 48
HYBRID_SAMPLES = 12
TRACED_SAMPLES = 20
TRUE_SAMPLES = 512
MOST_SAMPLES = 4096
# One frame's pattern of jitter may be a little less lucky than another's.
TOLERANCE = 0.002


@unittest.skipUnless(numpy, "python3-skimage is not installed")
@unittest.skipUnless(ASSETS.is_dir(), "HELIOGRAPH_TEST_ASSETS has no models")
class StaticViews(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.server = Server("--set", f"accumulation.max_samples={MOST_SAMPLES}",
                            "--scene", SCENES[0], scenes=str(ASSETS))

    @classmethod
    def tearDownClass(cls):
        cls.server.stop()

    def image(self, **parameters):
        capture = self.server.call("frame.capture", {"format": "png", **parameters})
        image = decode_png(base64.b64decode(capture["data"], validate=True))
        pixels = numpy.frombuffer(image.rgb, dtype=numpy.uint8)
        return pixels.reshape(image.height, image.width, 3)

    def truth(self):
        """Of other random numbers, and without what the denoiser knows."""
        self.server.call("settings.patch", {"patch": {"sampling": {"seed": 99}}})
        image = self.image(samples=TRUE_SAMPLES)
        self.server.call("settings.patch", {"patch": {"sampling": {"seed": 0}}})
        return image

    def path_traced_truth(self):
        full = {"use": "always", "scope": "full"}
        self.server.call("settings.patch", {"patch": {"sampling": {"seed": 99},
                                                      "reference": full}})
        image = self.image(samples=TRUE_SAMPLES)
        self.server.call("settings.patch", {"patch": {"sampling": {"seed": 0}, "reference": None}})
        return image

    def come_to_rest(self):
        self.server.call("camera.orbit", {"yaw": MOVED_FRAMES})
        self.server.call("frame.step", {"frames": 4, "dt": 0.03})
        for _ in range(MOVED_FRAMES):
            self.server.call("camera.orbit", {"yaw": -1})
            self.server.call("frame.step", {"frames": 1, "dt": 0.03})

    def check_samples(self, scene, truth, samples):
        """Of each more sample of the view the similarity to the truth."""
        self.come_to_rest()
        found = []
        for _ in range(samples):
            self.server.call("frame.step", {"frames": 1, "dt": 0.03})
            found.append(structural_similarity(truth, self.image(), channel_axis=2))
        self.server.call("frame.run")
        best = numpy.maximum.accumulate(found)
        worst = float((best - found).max())
        print(f"{scene}: from {found[0]:.4f} to {found[-1]:.4f}, at most {worst:.4f} less "
              "than before")
        self.assertLess(worst, TOLERANCE, [round(one, 4) for one in found])
        self.assertGreaterEqual(found[-1], found[0])

    def load(self, scene):
        self.server.call("scene.load", {"name": scene})
        self.server.call("animation.pause")

    def test_no_sample_makes_it_worse(self):
        for scene in SCENES:
            with self.subTest(scene=scene):
                self.load(scene)
                self.check_samples(scene, self.truth(), SAMPLES)

    def test_no_path_traced_sample_makes_it_worse(self):
        """Those that follow the hybrid's, whose truth is another one."""
        few = {"accumulation": {"max_samples": HYBRID_SAMPLES}, "reference": {"samples": 512}}
        before = {"accumulation": {"max_samples": MOST_SAMPLES}, "reference": None}
        self.server.call("settings.patch", {"patch": few})
        self.addCleanup(self.server.call, "settings.patch", {"patch": before})
        for scene in SCENES:
            with self.subTest(scene=scene):
                self.load(scene)
                self.check_samples(scene, self.path_traced_truth(), HYBRID_SAMPLES + TRACED_SAMPLES)


if __name__ == "__main__":
    unittest.main()
