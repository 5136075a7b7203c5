#!/usr/bin/env python3
"""The measures, the paired tests and the runner of the page of the paper's figures."""

import io
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE / "page"))

try:
    import matplotlib  # noqa: F401
    import numpy
    from skimage.metrics import structural_similarity
    import findings
    import measure
    import measures
    import paired
    import paper
    import plan
    import reasons
except ImportError as missing:
    print(f"skipped: {missing}")
    sys.exit(77)


BINARY = os.environ.get("HELIOGRAPH_EXPERIMENTS")


def ramp(width=64, height=48):
    y, x = numpy.mgrid[0:height, 0:width]
    return numpy.stack((x * 4, y * 5, 255 - x * 2 - y), -1).clip(0, 255).astype("uint8")


def noisy(image, reach, seed=3):
    noise = numpy.random.default_rng(seed).integers(-reach, reach + 1, image.shape)
    return (image.astype(int) + noise).clip(0, 255).astype("uint8")


def plain(color, width=32, height=32):
    return numpy.full((height, width, 3), color, "uint8")


class Ssim(unittest.TestCase):
    def test_is_that_of_scikit_image(self):
        truth = ramp()
        for image in (truth, noisy(truth, 10), noisy(truth, 60), numpy.roll(truth, 3, 1)):
            theirs = structural_similarity(
                image.astype(float) @ measures.LUMA, truth.astype(float) @ measures.LUMA,
                gaussian_weights=True, sigma=1.5, use_sample_covariance=False, data_range=255.0)
            self.assertAlmostEqual(measures.ssim(image, truth), theirs, 9)

    @unittest.skipUnless(BINARY, "HELIOGRAPH_EXPERIMENTS is not set")
    def test_of_the_experiments_is_the_same(self):
        """The program's number of a static view against that of the images that it wrote."""
        from PIL import Image
        with tempfile.TemporaryDirectory() as folder:
            # Static: all three ground truth frames are the one that is written.
            subprocess.run([BINARY, "--scenes", "cubes_distance", "--values", "0.2", "--movements",
                            "static", "--presets", "svgf", "--size", "64x36", "--frames", "4",
                            "--samples", "8", "--texture-size", "32", "--without-timings",
                            "--over-time", "--output", folder], check=True, capture_output=True)
            image, truth = (numpy.asarray(Image.open(
                f"{folder}/cubes_distance_20_static_{row}.png").convert("RGB"))
                for row in ("svgf", "ground_truth"))
            with open(f"{folder}/over_time.csv", encoding="utf-8") as file:
                last = file.read().splitlines()[-1]
        self.assertAlmostEqual(measures.ssim(image, truth), float(last.split(",")[-1]), 4)


class Flip(unittest.TestCase):
    def test_equal_images_have_no_error(self):
        self.assertEqual(measures.flip(ramp(), ramp()), 0.0)

    def test_opposite_primaries_are_the_largest_color_error(self):
        """Green and blue define the range (Andersson et al. 2020, section 4.1.3)."""
        self.assertAlmostEqual(measures.flip(plain((0, 255, 0)), plain((0, 0, 255))), 1.0, 6)

    def test_black_and_white_have_their_analytic_error(self):
        # HyAB distance 100, to the power 0.7; the range by definition that of green and blue.
        green, blue = (measures.hunt_lab(numpy.array(c)) for c in ((0., 1., 0.), (0., 0., 1.)))
        most = float(measures.hyab(green, blue)) ** 0.7
        expected = 0.95 + (100.0 ** 0.7 - 0.4 * most) / (0.6 * most) * 0.05
        self.assertAlmostEqual(measures.flip(plain(0), plain(255)), expected, 5)

    def test_range_of_colors(self):
        green, blue = (measures.hunt_lab(numpy.array(c)) for c in ((0., 1., 0.), (0., 0., 1.)))
        self.assertAlmostEqual(float(measures.hyab(green, blue)) ** 0.7, 41.28, 2)

    def test_a_lone_pixel_counts_more_than_its_color(self):
        """Points and edges raise the error of a feature that only one image has."""
        truth = plain(120, 41, 41)
        spot = truth.copy()
        spot[20, 20] = 255
        plain_color = measures.color_difference(*(measures.opponent(measures.linear(each))
                                                  for each in (spot, truth)))
        self.assertGreater(measures.flip_map(spot, truth)[20, 20], 1.15 * plain_color[20, 20])

    def test_grows_with_noise_and_is_symmetric(self):
        small, large = (measures.flip(noisy(ramp(), reach), ramp()) for reach in (5, 40))
        self.assertLess(small, large)
        self.assertAlmostEqual(large, measures.flip(ramp(), noisy(ramp(), 40)), 12)


class Paired(unittest.TestCase):
    def test_known_example(self):
        # t = 2.5 / (1.2910 / 2) = 3.873 with 3 degrees of freedom.
        test = paired.rises([1.0, 2.0, 3.0, 4.0])
        self.assertAlmostEqual(test.mean, 2.5)
        self.assertAlmostEqual(test.p, 0.0152, 4)
        self.assertAlmostEqual(test.low, 2.5 - 3.1824 * 1.29099 / 2.0, 3)
        self.assertAlmostEqual(paired.falls([1.0, 2.0, 3.0, 4.0]).p, 1.0 - 0.0152, 4)
        self.assertAlmostEqual(paired.different([-1.0, -2.0, -3.0, -4.0]).p, 0.0305, 4)

    def test_similar_needs_both_limits(self):
        self.assertLess(paired.similar([0.001, -0.001, 0.0], 0.01).p, 0.05)
        self.assertGreater(paired.similar([0.02, 0.021, 0.019], 0.01).p, 0.5)
        self.assertGreater(paired.similar([0.05, -0.05, 0.0], 0.01).p, 0.05)

    def test_one_seed_decides_nothing(self):
        test = paired.rises([0.5])
        self.assertEqual(findings.verdict_of(test), findings.OPEN)


class Statements(unittest.TestCase):
    def test_reasons_belong_to_statements(self):
        keys = [finding.key for finding in paper.FINDINGS]
        self.assertEqual(len(keys), len(set(keys)))
        times = {"12-slower", "13-slower", "12-iterations", "12-divergence", "14-slower",
                 "15-similar", "16-faster", "17-faster", "tables-30"}
        for table in (reasons.HOLDS, reasons.HOLDS_NOT):
            self.assertEqual(set(table) - set(keys) - times, set())

    def test_what_the_data_say_instead(self):
        other_way = paired.falls([0.02, 0.021, 0.022])
        self.assertIn("other way", findings.observed("falls", other_way))
        self.assertIn("noise", findings.observed("falls", paired.falls([0.02, -0.021, 0.0])))
        self.assertIn("larger than ±0.01", findings.observed(
            "similar", paired.similar([0.02, 0.021, 0.022], 0.01), 0.01))

    def test_rising_data_reproduce_a_rise_and_refute_a_fall(self):
        class Given:
            @staticmethod
            def quality(_kind, _scene, _movement, preset, _measure):
                gain = 0.02 if preset == "rectification" else 0.0
                return {0.0: {seed: 0.9 + gain + 0.001 * seed * (1 + gain) for seed in (1, 2, 3)}}
        outcomes = {outcome.key: outcome for outcome in findings.evaluate(Given)}
        self.assertEqual(outcomes["5a-zero"].verdict, findings.REPRODUCED)
        self.assertEqual(outcomes["9a-high"].verdict, findings.OPEN)
        falls = findings.run_test(paper.Finding("x", 5, "", "falls", ("static",), ()),
                                  [0.02, 0.021, 0.022])
        self.assertEqual(findings.verdict_of(falls), findings.NOT_REPRODUCED)


@unittest.skipUnless(BINARY, "HELIOGRAPH_EXPERIMENTS is not set")
class PresetPage(unittest.TestCase):
    def make(self, folder, *options):
        return subprocess.run(
            [sys.executable, HERE / "page" / "make_page.py", "--binary", BINARY, "--size", "tiny",
             "--output", folder, *options], capture_output=True, text=True)

    def test_two_presets_are_compared_in_every_scene(self):
        """One has no denoiser at all."""
        with tempfile.TemporaryDirectory() as folder:
            preset = pathlib.Path(folder) / "noisy.json"
            preset.write_text(json.dumps({
                "extends": "svgf", "specular_temporal": {"enabled": False},
                "specular_blur": {"enabled": False}, "shadow_temporal": {"enabled": False},
                "shadow_blur": {"enabled": False}}))
            done = self.make(folder, "--preset", preset, "--against", "best")
            self.assertEqual(done.returncode, 0, done.stderr)
            page = pathlib.Path(done.stdout.strip())
            text = page.read_text()
            settings = json.loads((page.parent / "data" / "settings.json").read_text())
        self.assertIn("noisy against best", text)
        rows = re.findall(r"<tr><th scope=\"row\">([^<]*)</th><td>([^<]*)</td><td>([^<]*)</td>"
                          r"<td>([-+.\d]+) [^<]*</td><td>([.\d]+)</td><td>2</td>"
                          r"<td><span class=\"verdict \w+\">([^<]*)", text)
        self.assertEqual(len(rows), 2 * 3 * 3, "scenes, movements and measures")
        for scene, movement, measured, change, p, verdict in rows:
            with self.subTest(scene=scene, movement=movement, measure=measured):
                self.assertEqual(verdict != "no difference beyond the seeds", float(p) < 0.05)
                if measured == "SSIM":
                    self.assertLess(float(change), 0.0)
        self.assertFalse(settings["noisy"]["shadow_blur"]["enabled"])
        self.assertTrue(settings["best"]["shadow_blur"]["enabled"])

    def test_a_mistake_in_a_preset_is_named(self):
        with tempfile.TemporaryDirectory() as folder:
            preset = pathlib.Path(folder) / "wrong.json"
            preset.write_text('{"shadow_blur": {"iteration": 3}}')
            done = self.make(folder, "--preset", preset)
            self.assertEqual(done.returncode, 1)
            self.assertIn("shadow_blur.iteration", done.stderr)
            done = self.make(folder, "--preset", "absent.json")
            self.assertIn("absent.json: no such file", done.stderr)


class Runner(unittest.TestCase):
    def unit(self, *arguments):
        return plan.Unit("unit", "a test", arguments, 1, 1.0)

    def test_a_unit_is_kept_only_with_the_same_options(self):
        with tempfile.TemporaryDirectory() as folder:
            folder = pathlib.Path(folder)
            self.assertFalse(measure.finished(folder, self.unit("a")))
            (folder / measure.DONE).write_text(json.dumps({"arguments": ["a"]}))
            self.assertTrue(measure.finished(folder, self.unit("a")))
            self.assertFalse(measure.finished(folder, self.unit("b")))

    @unittest.skipUnless(BINARY, "HELIOGRAPH_EXPERIMENTS is not set")
    def test_a_failure_says_why_and_leaves_nothing(self):
        with tempfile.TemporaryDirectory() as folder:
            with self.assertRaisesRegex(RuntimeError, "a test: .*nothing"):
                measure.measure(BINARY, [self.unit("--scenes", "nothing")], folder)
            self.assertFalse((pathlib.Path(folder) / "units" / "unit").exists())

    def test_progress_counts_what_is_kept(self):
        output = io.StringIO()
        progress = measure.Progress([self.unit("a"), self.unit("b")], output)
        progress.keep(self.unit("a"))
        progress.show(self.unit("b"), 1, "last line")
        self.assertRegex(output.getvalue(), r"^100 %, 0 min left: a test: last line")

    def test_every_scene_of_the_paper_is_measured(self):
        for name, size in plan.SIZES.items():
            names = [unit.name for unit in plan.Planner(size).units()]
            self.assertEqual(len(names), len(set(names)), name)
            for scene in size.scenes:
                self.assertIn(f"view_{scene}", names)
                self.assertIn(f"rates_{scene}", names)
        self.assertEqual(set(plan.SIZES["small"].scenes), set(paper.RATES))


if __name__ == "__main__":
    unittest.main()
