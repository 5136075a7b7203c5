#!/usr/bin/env python3
"""Renders the views of Khronos' glTF-Render-Fidelity set and tells where Heliograph stands there.

    HELIOGRAPH_TEST_ASSETS=... fidelity.py HELIOGRAPH FOLDER [--only ToyCar SheenChair] [--hybrid]

Each engine's image is compared with the path traced images of the other engines, by SSIM and FLIP,
both at the width of the set's thumbnails and over white. Bars: on every model with glass, cloth, a
coat or metal Heliograph is among the first two by both measures, and on every model its silhouette
differs by 1 % at most from the most similar of the path traced ones. The images and the table as
JSON (fidelity.json) are written to FOLDER. Exit status 1: a bar is missed or a view was not
rendered; 77: there is nothing to compare with.
"""

import argparse
import json
import os
import subprocess
import sys
from dataclasses import dataclass, field
from pathlib import Path

SKIPPED = 77

try:
    from PIL import Image
    import engines
    import lighting
    import materials
    import scenarios
    import standing
except ImportError as missing:
    print(f"skipped: {missing} (packages python3-numpy, python3-scipy, python3-pil)")
    sys.exit(SKIPPED)

OURS = "heliograph"
MOST_PLACE = 2
MOST_SILHOUETTE = 0.01
COLUMNS = "{:<42} {:<22} {:>7} {:>7} {:>9} {:>9} {:>10}  {}"


@dataclass
class View:
    """A view of the set, what it needs, and what was found."""
    scenario: scenarios.Scenario
    images: dict  # of other engines: their files
    model: Path = None
    environment: Path = None
    output: Path = None
    kinds: list = field(default_factory=list)
    skipped: str = ""  # why it is not compared
    failed: str = ""  # why it was not rendered
    result: dict = None


def planned(fidelity_set, scenario, folder):
    view = View(scenario, fidelity_set.images(scenario),
                model=fidelity_set.file(scenario.model), output=folder / f"{scenario.name}.png")
    environment = fidelity_set.file(scenario.lighting)
    if not view.model:
        view.skipped = f"{scenario.model} is missing"
    elif not environment:
        view.skipped = f"{scenario.lighting} is missing"
    elif not engines.path_traced(view.images):
        view.skipped = "there is no path traced image"
    else:
        view.environment = lighting.environment_file(environment, folder)
        view.kinds = materials.kinds_of(view.model)
    return view


def render(options, views):
    """Writes the views' images with one process, and why one is missing into the view."""
    manifest, report = options.folder / "manifest.json", options.folder / "report.json"
    for path in (report, *(view.output for view in views)):
        path.unlink(missing_ok=True)
    manifest.write_text(json.dumps([
        scenarios.manifest_entry(view.scenario, view.model, view.environment, view.output,
                                 options.samples, options.hybrid) for view in views], indent=1))
    command = [options.heliograph, "render", "--manifest", manifest, "--report", report,
               "--progress", "none"]
    if options.time_limit:
        command += ["--time-limit", options.time_limit]
    run = subprocess.run([str(part) for part in command], check=False)
    entries = json.loads(report.read_text())["entries"] if report.exists() else []
    reasons = {entry["entry"]: entry.get("reason") for entry in entries}
    for number, view in enumerate(views, 1):
        if not view.output.is_file():
            view.failed = reasons.get(number) or f"heliograph ended with status {run.returncode}"


def compare(view, most_width):
    """Fills in the result, or why there is none."""
    files = {**view.images, OURS: view.output}
    images = {name: Image.open(path) for name, path in files.items()}
    fitting = {name: image for name, image in images.items()
               if standing.has_aspect(image, view.scenario)}
    truths = engines.path_traced(fitting)
    if not truths:
        view.skipped = "no path traced image has the view's proportions"
        return
    size = standing.common_size(view.scenario, fitting.values(), most_width)
    pixels = {name: standing.scaled(image, size) for name, image in fitting.items()}
    scores = standing.scores_of({name: standing.over_white(each) for name, each in pixels.items()},
                                truths)
    by_ssim, by_flip = standing.places_of(scores, OURS)
    view.result = {
        "size": size, "path_traced": truths, "left_out": sorted(set(images) - set(fitting)),
        "scores": {name: {"ssim": score.ssim, "flip": score.flip}
                   for name, score in scores.items()},
        "place_by_ssim": by_ssim, "place_by_flip": by_flip,
        "silhouette": standing.silhouette_difference(pixels[OURS], [pixels[t] for t in truths])}


def missed_bars(view):
    """What is wrong with a view that was compared."""
    missed = []
    if view.kinds:
        for measure in ("ssim", "flip"):
            place = view.result[f"place_by_{measure}"]
            if place > MOST_PLACE:
                missed.append(f"{measure.upper()}: place {place}")
    share = view.result["silhouette"]
    if share is not None and share > MOST_SILHOUETTE:
        missed.append(f"silhouette: {share:.1%}")
    return missed


def row(view):
    if view.skipped or view.failed:
        return (f"{view.scenario.name:<42} "
                + (f"skipped: {view.skipped}" if view.skipped else f"FAILED: {view.failed}"))
    result = view.result
    of = len(result["scores"])
    share = result["silhouette"]
    missed = missed_bars(view)
    return COLUMNS.format(
        view.scenario.name, ", ".join(view.kinds) or "-", f"{result['scores'][OURS]['ssim']:.4f}",
        f"{result['scores'][OURS]['flip']:.4f}", f"{result['place_by_ssim']} of {of}",
        f"{result['place_by_flip']} of {of}", "-" if share is None else f"{share:.2%}",
        "MISSED " + ", ".join(missed) if missed else "met")


def record(view):
    entry = {"name": view.scenario.name, "kinds": view.kinds}
    if view.skipped or view.failed:
        return {**entry, **{state: text for state, text in (("skipped", view.skipped),
                                                            ("failed", view.failed)) if text}}
    return {**entry, **view.result, "missed": missed_bars(view)}


def chosen(fidelity_set, names):
    if not names:
        return fidelity_set.scenarios
    return [scenario for scenario in fidelity_set.scenarios
            if scenario.name.removeprefix("khronos-") in names or scenario.name in names]


def parse():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("heliograph", type=Path)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--only", nargs="+", metavar="NAME", help="these views")
    parser.add_argument("--samples", type=int, default=256, help="per pixel")
    parser.add_argument("--time-limit", type=float, help="seconds for an image")
    parser.add_argument("--hybrid", action="store_true",
                        help="the hybrid renderer, not the path tracer")
    parser.add_argument("--width", type=int, default=512, help="most pixels to compare at")
    return parser.parse_args()


def main():
    options = parse()
    assets = os.environ.get("HELIOGRAPH_TEST_ASSETS")
    if not assets:
        print("skipped: HELIOGRAPH_TEST_ASSETS is not set")
        return SKIPPED
    fidelity_set = scenarios.find_set(Path(assets))
    if not fidelity_set:
        print(f"skipped: {assets} has no folder {scenarios.GENERATOR} or {scenarios.SITE}")
        return SKIPPED
    options.folder = options.folder.resolve()
    options.folder.mkdir(parents=True, exist_ok=True)
    for engine in engines.unknown(fidelity_set.engines):
        print(f"engines.py lacks {engine}: it is not taken for a path tracer")
    views = [planned(fidelity_set, scenario, options.folder)
             for scenario in chosen(fidelity_set, options.only)]
    ready = [view for view in views if not view.skipped]
    if ready:
        render(options, ready)
    print(COLUMNS.format("view", "materials", "SSIM", "FLIP", "by SSIM", "by FLIP", "silhouette",
                         "bars"))
    for view in views:
        if not view.skipped and not view.failed:
            compare(view, options.width)
        print(row(view), flush=True)
    records = [record(view) for view in views]
    (options.folder / "fidelity.json").write_text(json.dumps(
        {"samples": options.samples, "hybrid": options.hybrid, "views": records}, indent=1))
    missed = [one["name"] for one in records if one.get("missed") or "failed" in one]
    compared = sum("scores" in one for one in records)
    if not compared and not missed:
        print(f"skipped: none of {len(views)} views can be compared")
        return SKIPPED
    print(f"{compared} views compared, {len(missed)} missed a bar or failed")
    return 1 if missed else 0


if __name__ == "__main__":
    sys.exit(main())
