#!/usr/bin/env python3
"""Measures rendering as a service against its bars, beside headless Chromium with three.js and beside Blender.

    HELIOGRAPH_BINARY=build/bin/heliograph HELIOGRAPH_TEST_ASSETS=models tests/bench/service/bars.py -o bars.json
    ... bars.py --only start dask
    ... bars.py --smoke      # without the others, as short as possible: the figures mean nothing

Run it on a machine that does nothing else. Chromium renders with three.js where npm can install it, in software as
heliograph does, and Debian's Blender with Cycles; what cannot be measured is listed as skipped with its reason. The
status is 1 if a bar is missed.
"""

import argparse
import json
import os
import sys
import tempfile

import measures
from blender import Blender
from chromium import Chromium
from measures import Unavailable

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.normpath(os.path.join(HERE, "..", "..", ".."))


class Row:
    """One figure, what it is compared with, and whether it is good enough; None: not measured."""

    def __init__(self, name, value, unit, bar="", met=None):
        self.name, self.value, self.unit, self.bar, self.met = name, value, unit, bar, met

    def text(self):
        value = self.value if isinstance(self.value, str) else f"{self.value:.3g} {self.unit}"
        verdict = "" if self.met is None else "met" if self.met else "MISSED"
        return f"{self.name:<48} {value:<28} {self.bar:<28} {verdict}"


def at_most(name, value, unit, bar):
    return Row(name, value, unit, f"<= {bar:g} {unit}", value <= bar)


def at_least(name, value, unit, bar):
    return Row(name, value, unit, f">= {bar:g} {unit}", value >= bar)


CHROMIUM = "Chromium with three.js"
CYCLES = "Blender with Cycles"


def beside(setup, name, ours, other, measure, faster=1.0):
    """Rows of the same work by another program, which ours must be so many times faster than."""
    if setup.smoke:
        return []
    try:
        theirs = measure()
    except Unavailable as reason:
        return [Row(f"{name}, {other}", f"skipped: {reason}", "")]
    return [Row(f"{name}, {other}", theirs, "s"),
            Row(f"{name}, ratio", theirs / ours, "", f"> {faster:g}", theirs > faster * ours)]


def images(setup):
    models = measures.find_models(setup.assets, 2 if setup.smoke else 100)
    views = [[-30, 20], [90, 10], [200, 40]][:1 if setup.smoke else 3]
    size = 64 if setup.smoke else 512
    set_of_images = measures.render_images(setup, models, views, size, 0.97)
    rows = [Row("images: models x views", f"{len(models)} x {len(views)}", ""),
            at_most("images: median", set_of_images.median, "s", 0.6),
            Row("images: 95th percentile", set_of_images.slow, "s"),
            at_most("images: peak memory", set_of_images.peak_mib, "MiB", 400),
            Row("images: failed entries", str(set_of_images.failed), "")]
    similarity = measures.similarity_to_truth(setup, set_of_images, 1 if setup.smoke else 6)
    rows.append(at_least("images: least similarity to the converged", similarity, "", 0.97)
                if similarity is not None else
                Row("images: similarity", "skipped: python3-skimage is not installed", ""))
    for other, program in ((CHROMIUM, setup.chromium), (CYCLES, setup.blender)):
        rows += beside(setup, "images: median", set_of_images.median, other,
                       lambda program=program: program.median_of_images(models, views, size))
    return rows


def turntable(setup):
    model = measures.named_model(setup.assets, "DamagedHelmet")
    frames, size = (3, (64, 36)) if setup.smoke else (72, (1280, 720))
    quality = 0.97
    # Both in the same light.
    environment = measures.named_environment(setup.assets, "venice")
    ours = measures.render_turntable(setup, model, frames, size, quality, environment)
    return [Row(f"turntable: {frames} frames, MP4", ours, "s"),
            *beside(setup, "turntable", ours, CYCLES,
                    lambda: setup.blender.turntable(model, frames, size, quality, environment),
                    faster=5.0)]


def start(setup):
    model = measures.named_model(setup.assets, "Duck")
    ours = measures.start_to_image(setup, model, 1 if setup.smoke else 5)
    return [at_most("start to the first image: median", ours, "s", 0.8),
            *beside(setup, "start to the first image", ours, CHROMIUM,
                    lambda: setup.chromium.screenshot(model, 5))]


def dask(setup):
    if not measures.has_dask():
        return [Row("dask", "skipped: python3-distributed is not installed", "")]
    workers = 2 if setup.smoke else 4
    found = measures.farm(setup, measures.named_model(setup.assets, "Duck"), workers)
    row = at_least if not setup.smoke else lambda name, value, unit, bar: Row(name, value, unit)
    return [Row("dask: one process of one thread", found.alone, "s"),
            Row(f"dask: {workers} workers of one thread, {found.cores} cores", found.together, "s"),
            row("dask: share of the cores' worth", found.efficiency, "", 0.9),
            Row("dask: files lost with a killed worker", str(found.lost), "", "0", found.lost == 0)]


def interactive(setup):
    jobs, seconds = (3, 1) if setup.smoke else (1000, 20)
    alone, beside = measures.viewer_beside_jobs(setup, jobs, seconds)
    ratio = beside / alone
    return [Row("interactive: 95th percentile alone", 1e3 * alone, "ms"),
            Row(f"interactive: while {jobs} jobs wait", 1e3 * beside, "ms"),
            Row("interactive: ratio", ratio, "") if setup.smoke else
            at_most("interactive: ratio", ratio, "", 1.5)]


MEASUREMENTS = {measure.__name__: measure for measure in (start, interactive, dask, turntable, images)}


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--only", nargs="+", choices=MEASUREMENTS, default=list(MEASUREMENTS))
    parser.add_argument("--smoke", action="store_true", help="without the others, as short as possible")
    parser.add_argument("-o", "--output", help="JSON file of all rows")
    options = parser.parse_args()
    if not os.environ.get("HELIOGRAPH_TEST_ASSETS"):
        print("skipped: HELIOGRAPH_TEST_ASSETS is not set")
        return 77
    rows = []
    with tempfile.TemporaryDirectory() as folder, Chromium(folder, HERE) as chromium:
        setup = measures.Setup(binary=os.environ["HELIOGRAPH_BINARY"], root=ROOT, folder=folder, smoke=options.smoke,
                               assets=os.environ["HELIOGRAPH_TEST_ASSETS"], chromium=chromium,
                               blender=Blender(folder, HERE))
        for name in options.only:
            for row in MEASUREMENTS[name](setup):
                rows.append(row)
                print(row.text(), flush=True)
    if options.output:
        with open(options.output, "w", encoding="utf-8") as file:
            json.dump([vars(row) for row in rows], file, indent=2)
    return 1 if any(row.met is False for row in rows) and not options.smoke else 0


if __name__ == "__main__":
    sys.exit(main())
