"""Two presets beside each other: is a difference larger than the noise of seeds?"""

import json
import math
import pathlib
from html import escape

import markup
import paired
import paper
import sheets
from chart import Chart
from markup import section, table
from plan import MOVEMENTS

HERE = pathlib.Path(__file__).parent
MEASURES = {"ssim": ("SSIM", True), "flicker": ("flicker", False),
            "luminance_ratio": ("luminance / ground truth", None)}


def pairs(results, scene, movement, measure, preset, against):
    """One difference per seed: the mean of the swept values."""
    mine = results.quality("preset", scene, movement, preset, measure)
    other = results.quality("preset", scene, movement, against, measure)
    by_seed = {}
    for value, seeds in mine.items():
        for seed, number in seeds.items():
            by_seed.setdefault(seed, []).append(number - other[value][seed])
    return [sum(each) / len(each) for each in by_seed.values()]


def verdict(test, higher_is_better):
    if math.isnan(test.p) or test.p >= 0.05:
        return "no difference beyond the seeds", "soft"
    if higher_is_better is None:
        return "different", "soft"
    better = (test.mean > 0.0) == higher_is_better
    return ("better", "yes") if better else ("worse", "no")


def tests_table(results, scenes, preset, against):
    rows = []
    for scene in scenes:
        for movement in MOVEMENTS:
            for measure, (title, higher) in MEASURES.items():
                differences = pairs(results, scene, movement, measure, preset, against)
                if not differences:
                    continue
                test = paired.different(differences)
                words, look = verdict(test, higher)
                rows.append((paper.SCENE_TITLES[scene], paper.MOVEMENT_TITLES[movement], title,
                             f"{test.mean:+.4f} ({test.low:+.4f} to {test.high:+.4f})",
                             f"{test.p:.4f}", str(test.count),
                             f'<span class="verdict {look}">{words}</span>'))
    return table(("scene", "movement", "measure", "change, 95 % interval", "p", "seeds", "verdict"),
                 rows, f"{preset} less {against}, pairs with the same seed, two-sided t test")


def charts(results, scenes, preset, against):
    for scene in scenes:
        chart = Chart(f"preset-{scene.replace('_', '-')}", paper.SCENE_TITLES[scene],
                      "SSIM over the swept value: mean of the seeds, and their range.",
                      len(MOVEMENTS))
        for axes, movement in zip(chart.axes, MOVEMENTS):
            for name, label in ((preset, preset), (against, against)):
                x, mean, low, high = results.curve("preset", scene, movement, name)
                chart.line(axes, f"{movement}-{name}", name, label, x, mean,
                           {"file": "quality.csv", "kind": "preset", "scene": scene,
                            "movement": movement, "preset": name, "x": "value", "y": "ssim"},
                           low, high)
            axes.set_title(paper.MOVEMENT_TITLES[movement])
            axes.tick_params(labelleft=True)
        chart.axes[0].set_ylabel("SSIM")
        yield chart.finish()


def times_table(results, scenes, preset, against):
    rows = []
    for scene in scenes:
        for row in results.rows["timings.csv"]:
            if row["scene"] == scene and row["preset"] in (preset, against):
                rows.append((paper.SCENE_TITLES[scene], row["value"], row["movement"],
                             row["preset"], f'{float(row["avg_fps"]):.1f}'))
    return table(("scene", "value", "movement", "preset", "frames per second"), rows, "Times")


def write(results, size, output, preset, against):
    output = pathlib.Path(output)
    scenes = [scene for scene in paper.SCENE_TITLES
              if results.quality("preset", scene, "static", preset)]
    files = results.write(output / "data")
    run = next(iter(results.runs.values()))
    (output / "data" / "settings.json").write_text(json.dumps(run["settings"], indent=1) + "\n")
    links = ", ".join(f'<a href="data/{name}">{name}</a>' for name in [*files, "settings.json"])
    figures = "".join(markup.figure(chart) for chart in charts(results, scenes, preset, against))
    title = f"{preset} against {against}"
    body = (f"<header><h1>{escape(title)}</h1><p>{run['size']}, {run['frames']} frames, size "
            f"“{size.name}”, {escape(results.device())}. Data: {links}.</p></header><main>"
            + section("tests", "Is the difference larger than the noise of seeds?",
                      tests_table(results, scenes, preset, against))
            + section("figures", "Quality", figures)
            + section("times", "Frame rates", times_table(results, scenes, preset, against))
            + "</main>")
    path = output / "index.html"
    path.write_text(markup.document(title, (HERE / "page.css").read_text(),
                                    (HERE / "page.js").read_text(), body))
    return path
