#!/usr/bin/env python3
"""Renders a chart of material balls beside the path traced truth, and measures how alike they are.

    material_chart.py HELIOGRAPH HELIOGRAPH_SCENES FOLDER [--small] [--rows sheen clearcoat]

Generates the scene `material_balls` (scenes/README.md says what its rows are), renders each row by
the hybrid and by the path tracer with all light paths, and compares each ball with its truth by
SSIM and FLIP. FOLDER gets the images, the sheet of all (chart.png: hybrid, truth, difference) and
the table as JSON (chart.json). A row misses its bar where its worst ball has less SSIM than
material_bars.py says. Exit status 1: a bar is missed or a row was not rendered; 77: a program or a
package is missing.
"""

import argparse
import json
import subprocess
import sys
from dataclasses import dataclass, field
from pathlib import Path

SKIPPED = 77

try:
    import numpy
    from PIL import Image
    import material_bars
    import materials
    import material_sheet
    from standing import measures
except ImportError as missing:
    print(f"skipped: {missing} (packages python3-numpy, python3-scipy, python3-pil)")
    sys.exit(SKIPPED)

SCENE = "material_balls"
# The same light, exposure and curve for both; the light that glass bends is in both.
SETTINGS = {"exposure": {"mode": "manual", "compensation": 0.0},
            "transmission": {"refraction": True}}
# Enough for light through both walls of a ball, its shadow and the light of its neighbours.
BOUNCES = 12
COLUMNS = "{:<28} {:>8} {:>7} {:>7}  {}"


@dataclass
class Ball:
    value: str
    ssim: float = None
    flip: float = None


@dataclass
class Row:
    """A row of the scene: the camera of its name sees its balls, from left to right."""
    name: str
    balls: list = field(default_factory=list)
    hybrid_file: Path = None
    truth_file: Path = None
    image: numpy.ndarray = None
    truth: numpy.ndarray = None
    failed: str = ""

    def least_ssim(self):
        return min(ball.ssim for ball in self.balls)


def rows_of(scene):
    """The rows of a scene, as its nodes are named: ROW=VALUE, with a camera named ROW each."""
    document, _ = materials.read(scene)
    cameras = {node["name"] for node in document["nodes"] if "camera" in node}
    rows = {}
    for node in document["nodes"]:
        name, separator, value = node["name"].partition("=")
        if "mesh" in node and separator and name in cameras:
            rows.setdefault(name, Row(name)).balls.append(Ball(value))
    return list(rows.values())


def generate(options):
    """@return the scene's file. Ends the program where it cannot be made."""
    folder = options.folder / "scene"
    run = subprocess.run([options.scenes, folder, "--only", SCENE], check=False,
                         stdout=subprocess.DEVNULL)
    if run.returncode != 0:
        raise SystemExit(f"FAILED: {options.scenes} ended with status {run.returncode}")
    return folder / f"{SCENE}.glb"


def entry(options, scene, row, truth):
    """Of the manifest: one image of a row."""
    one = {"scene": str(scene), "camera": row.name, "width": options.size * len(row.balls),
           "height": options.size, "background": "sky", "settings": SETTINGS,
           "samples": options.samples, "output": str(row.hybrid_file)}
    if truth:
        one |= {"reference": "full", "samples": options.reference_samples,
                "settings": {**SETTINGS, "reference": {"bounces": BOUNCES}},
                "output": str(row.truth_file)}
    return one


def render(options, scene, rows):
    """Writes both images of each row with one process, and why one is missing into the row."""
    images = [(row, truth) for truth in (False, True) for row in rows]
    for row in rows:
        row.hybrid_file = options.folder / f"{row.name}_hybrid.png"
        row.truth_file = options.folder / f"{row.name}_truth.png"
    manifest, report = options.folder / "manifest.json", options.folder / "report.json"
    for path in (report, *(row.hybrid_file for row in rows), *(row.truth_file for row in rows)):
        path.unlink(missing_ok=True)
    manifest.write_text(json.dumps([entry(options, scene, row, truth) for row, truth in images],
                                   indent=1))
    run = subprocess.run([options.heliograph, "render", "--manifest", manifest, "--report", report,
                          "--progress", "none"], check=False)
    entries = json.loads(report.read_text())["entries"] if report.exists() else []
    reasons = {one["entry"]: one.get("reason") for one in entries}
    for number, (row, truth) in enumerate(images, 1):
        if not (row.truth_file if truth else row.hybrid_file).is_file():
            row.failed = reasons.get(number) or f"heliograph ended with status {run.returncode}"


def pixels(path):
    with Image.open(path) as image:
        return numpy.asarray(image.convert("RGB"))


def compare(row):
    """Reads the images of a row and fills in what is measured of each ball's square."""
    row.image, row.truth = pixels(row.hybrid_file), pixels(row.truth_file)
    size = row.image.shape[0]
    for index, ball in enumerate(row.balls):
        square = numpy.s_[:, index * size:(index + 1) * size]
        ball.ssim = measures.ssim(row.image[square], row.truth[square])
        ball.flip = measures.flip(row.image[square], row.truth[square])


def misses(row, bars):
    """A row without a bar misses it, so that none is forgotten."""
    return row.name not in bars or row.least_ssim() < bars[row.name]


def print_row(row, bars):
    if row.failed:
        print(f"{row.name:<28} FAILED: {row.failed}", flush=True)
        return
    bar = bars.get(row.name)
    for ball in row.balls:
        state = "NO BAR" if bar is None else f"MISSED {bar}" if ball.ssim < bar else "met"
        print(COLUMNS.format(row.name, ball.value, f"{ball.ssim:.4f}", f"{ball.flip:.4f}", state),
              flush=True)


def record(row, bars):
    if row.failed:
        return {"name": row.name, "failed": row.failed}
    return {"name": row.name, "bar": bars.get(row.name), "missed": misses(row, bars),
            "balls": [{"value": ball.value, "ssim": ball.ssim, "flip": ball.flip}
                      for ball in row.balls]}


def print_bars(rows):
    """As material_bars.py has them."""
    for row in rows:
        print(f'    "{row.name}": {material_bars.bar_of(row.least_ssim())},')


def parse(arguments=None):
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("heliograph", type=Path, help="the server's program")
    parser.add_argument("scenes", type=Path, help="the program heliograph-scenes")
    parser.add_argument("folder", type=Path, help="for what is written")
    parser.add_argument("--rows", nargs="+", metavar="ROW", help="these rows [all]")
    parser.add_argument("--small", action="store_true",
                        help="other defaults, and the bars of a small chart: a minute or two")
    parser.add_argument("--size", type=int, help="width and height of a ball's square [96; 32]")
    parser.add_argument("--samples", type=int, help="of the hybrid, per pixel [64]")
    parser.add_argument("--reference-samples", type=int,
                        help="of the path tracer, per pixel [1024; 256]")
    parser.add_argument("--scene", type=Path, help="a scene with such rows, not the generated one")
    parser.add_argument("--print-bars", action="store_true",
                        help="print what was measured as bars for material_bars.py")
    options = parser.parse_args(arguments)
    defaults = (32, 64, 256) if options.small else (96, 64, 1024)
    for name, value in zip(("size", "samples", "reference_samples"), defaults):
        if getattr(options, name) is None:
            setattr(options, name, value)
    options.bars = material_bars.SMALL if options.small else material_bars.WHOLE
    return options


def missing_program(options):
    programs = [options.heliograph] + ([] if options.scene else [options.scenes])
    return next((program for program in programs if not program.is_file()), None)


def chosen(rows, names):
    if not names:
        return rows
    unknown = set(names) - {row.name for row in rows}
    if unknown:
        raise SystemExit(f"no row {', '.join(sorted(unknown))}; there are "
                         + ", ".join(row.name for row in rows))
    return [row for row in rows if row.name in names]


def main():
    options = parse()
    program = missing_program(options)
    if program:
        print(f"skipped: {program} is missing")
        return SKIPPED
    options.folder = options.folder.resolve()
    options.folder.mkdir(parents=True, exist_ok=True)
    scene = options.scene or generate(options)
    rows = chosen(rows_of(scene), options.rows)
    render(options, scene, rows)
    print(COLUMNS.format("row", "value", "SSIM", "FLIP", "bar"))
    for row in rows:
        if not row.failed:
            compare(row)
        print_row(row, options.bars)
    done = [row for row in rows if not row.failed]
    missed = [row.name for row in done if misses(row, options.bars)]
    if done:
        material_sheet.sheet_of(done, missed).save(options.folder / "chart.png")
    (options.folder / "chart.json").write_text(json.dumps(
        {"size": options.size, "samples": options.samples,
         "reference_samples": options.reference_samples,
         "rows": [record(row, options.bars) for row in rows]}, indent=1))
    if options.print_bars:
        print_bars(done)
    print(f"{len(done)} of {len(rows)} rows compared, {len(missed)} missed their bars: "
          f"{options.folder / 'chart.png'}")
    return 1 if missed or len(done) < len(rows) or not rows else 0


if __name__ == "__main__":
    sys.exit(main())
