#!/usr/bin/env python3
"""The parts of the chart of material balls, without the programs."""

import contextlib
import io
import json
import sys
import tempfile
import unittest
from pathlib import Path

try:
    import numpy
    import material_bars
    import material_chart
    import material_sheet
except ImportError as missing:
    print(f"skipped: {missing}")
    sys.exit(77)

SIZE = 40
NOISE = numpy.random.default_rng(5).integers(0, 256, (SIZE, 2 * SIZE, 3)).astype(numpy.uint8)


def nodes(*names, camera="sheen"):
    return [{"name": "main", "camera": 0}, {"name": camera, "camera": 1},
            *({"name": name, "mesh": 0} for name in names)]


def compared(first, second, name="sheen"):
    """A row of two balls with these images of both."""
    row = material_chart.Row(name, [material_chart.Ball("0"), material_chart.Ball("0.5")])
    with tempfile.TemporaryDirectory() as folder:
        row.hybrid_file, row.truth_file = Path(folder) / "hybrid.png", Path(folder) / "truth.png"
        for path, pixels in ((row.hybrid_file, first), (row.truth_file, second)):
            material_sheet.Image.fromarray(pixels).save(path)
        material_chart.compare(row)
    return row


class Rows(unittest.TestCase):
    def rows(self, *names, **options):
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "scene.gltf"
            path.write_text(json.dumps({"nodes": nodes(*names, **options)}))
            return material_chart.rows_of(path)

    def test_are_named_by_nodes(self):
        rows = self.rows("ground", "sheen=0", "sheen=0.5", "other=1")
        self.assertEqual([row.name for row in rows], ["sheen"])
        self.assertEqual([ball.value for ball in rows[0].balls], ["0", "0.5"])

    def test_need_a_camera(self):
        self.assertEqual(self.rows("sheen=0", camera="clearcoat"), [])

    def test_are_chosen_by_name(self):
        rows = self.rows("sheen=0")
        self.assertEqual(material_chart.chosen(rows, None), rows)
        self.assertEqual(material_chart.chosen(rows, ["sheen"]), rows)
        with self.assertRaisesRegex(SystemExit, "no row coat; there are sheen"):
            material_chart.chosen(rows, ["coat"])


class Manifest(unittest.TestCase):
    def entry(self, truth, *options):
        parsed = material_chart.parse(["heliograph", "scenes", "out", *options])
        row = material_chart.Row("sheen", [material_chart.Ball("0")] * 5, Path("a"), Path("b"))
        return material_chart.entry(parsed, "scene.glb", row, truth)

    def test_hybrid_and_truth_have_the_same_view_and_settings(self):
        hybrid, truth = self.entry(False), self.entry(True)
        for member in ("scene", "camera", "width", "height", "background"):
            self.assertEqual(hybrid[member], truth[member])
        self.assertEqual((hybrid["width"], hybrid["height"]), (480, 96))
        self.assertNotIn("reference", hybrid)
        self.assertEqual(truth["reference"], "full")
        self.assertEqual({**truth["settings"], "reference": None},
                         {**hybrid["settings"], "reference": None})
        self.assertEqual((hybrid["output"], truth["output"]), ("a", "b"))

    def test_small_has_other_defaults_and_bars(self):
        self.assertEqual(self.entry(True, "--small")["height"], 32)
        self.assertEqual(self.entry(True, "--small", "--size", "64")["height"], 64)
        small = material_chart.parse(["a", "b", "c", "--small"])
        self.assertIs(small.bars, material_bars.SMALL)
        self.assertIs(material_chart.parse(["a", "b", "c"]).bars, material_bars.WHOLE)


class Measures(unittest.TestCase):
    def test_each_ball_is_measured_in_its_square(self):
        changed = NOISE.copy()
        changed[:, SIZE:] = 255 - changed[:, SIZE:]
        row = compared(changed, NOISE)
        self.assertAlmostEqual(row.balls[0].ssim, 1.0, 9)
        self.assertEqual(row.balls[0].flip, 0.0)
        self.assertLess(row.balls[1].ssim, 0.1)
        self.assertGreater(row.balls[1].flip, 0.2)
        self.assertEqual(row.least_ssim(), row.balls[1].ssim)

    def test_the_worst_ball_counts(self):
        changed = NOISE.copy()
        changed[:, SIZE:] = 255 - changed[:, SIZE:]
        row = compared(changed, NOISE)
        self.assertTrue(material_chart.misses(row, {"sheen": 0.5}))
        self.assertFalse(material_chart.misses(compared(NOISE, NOISE), {"sheen": 0.5}))
        self.assertTrue(material_chart.misses(compared(NOISE, NOISE), {}))
        self.assertTrue(material_chart.record(row, {"sheen": 0.5})["missed"])
        output = io.StringIO()
        with contextlib.redirect_stdout(output):
            material_chart.print_row(row, {"sheen": 0.5})
        self.assertEqual(["MISSED" in line for line in output.getvalue().splitlines()],
                         [False, True])


class Bars(unittest.TestCase):
    def test_are_below_what_was_measured(self):
        for measured in (0.5, 0.907, 0.92, 0.9999, 1.0):
            bar = material_bars.bar_of(measured)
            self.assertLessEqual(bar, measured - material_bars.MARGIN + 1e-9)
            self.assertGreater(bar, measured - material_bars.MARGIN - 0.011)

    def test_both_charts_have_the_same_rows(self):
        self.assertEqual(list(material_bars.WHOLE), list(material_bars.SMALL))
        for bar in (*material_bars.WHOLE.values(), *material_bars.SMALL.values()):
            self.assertTrue(0.0 < bar < 1.0)


class Sheet(unittest.TestCase):
    def sheet(self, row, missed=()):
        return numpy.asarray(material_sheet.sheet_of([row], missed)).astype(int)

    def test_shows_hybrid_truth_and_difference(self):
        first, second = NOISE // 2, NOISE // 2 + 10
        sheet = self.sheet(compared(first, second))
        factor = -(-material_sheet.LEAST_SQUARE // SIZE)
        height, width = SIZE * factor, 2 * SIZE * factor
        for number, expected in enumerate((first, second, numpy.full_like(NOISE, 40))):
            left = material_sheet.LABELS + number * (width + material_sheet.GAP)
            found = sheet[material_sheet.LINE:material_sheet.LINE + height, left:left + width]
            numpy.testing.assert_array_equal(found[::factor, ::factor], expected)

    def test_a_missed_row_is_red(self):
        row = compared(NOISE, NOISE)
        for missed in (False, True):
            label = self.sheet(row, ["sheen"] if missed else [])[:, :material_sheet.LABELS]
            red = (label[..., 0] - label[..., 1] > 100).any()
            self.assertEqual(red, missed)


class Programs(unittest.TestCase):
    def test_what_is_missing_is_told(self):
        options = material_chart.parse([sys.executable, "/missing/heliograph-scenes", "out"])
        self.assertEqual(material_chart.missing_program(options), options.scenes)
        options = material_chart.parse([sys.executable, "/missing", "out", "--scene", "a.glb"])
        self.assertIsNone(material_chart.missing_program(options))


if __name__ == "__main__":
    unittest.main()
