"""What was measured, read from the folders of all units."""

import collections
import csv
import json
import pathlib
import statistics

from measure import DONE
from plan import INDIRECT, UPSAMPLED
from stages import stage_of

QUALITY = "quality.csv"
TIMES = "timings.csv"
PASSES = "passes.csv"
OVER_TIME = "over_time.csv"


def read(path):
    if not path.exists():
        return []
    with open(path, newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def kind_of(unit):
    return unit.split("_", 1)[0]


def name_of(kind, preset):
    """Temporal upsampling and indirect light are `best` with something more: a name of their own."""
    if kind == "upsampled" and preset == "best":
        return UPSAMPLED
    if kind == "indirect" and preset == "best":
        return INDIRECT
    return preset


class Results:
    """Rows of all units, as dictionaries of text, each with the unit's name and kind."""

    def __init__(self, folder, names):
        """names: of the units that count; a folder may hold others, of an earlier plan"""
        self.folder = pathlib.Path(folder)
        units = self.folder / "units"
        self.units = [units / name for name in sorted(names) if (units / name / DONE).exists()]
        self.rows = {name: [] for name in (QUALITY, TIMES, PASSES, OVER_TIME)}
        self.runs = {}
        for unit in self.units:
            kind = kind_of(unit.name)
            for name, rows in self.rows.items():
                for row in read(unit / name):
                    named = name_of(kind, row["preset"])
                    row = {"unit": unit.name, "kind": kind, **row, "preset": named}
                    if name == PASSES:
                        row["stage"] = stage_of(row["pass"])
                    rows.append(row)
            self.runs[unit.name] = json.loads((unit / "experiments.json").read_text())["run"]

    def quality(self, kind, scene, movement, preset, measure="ssim"):
        """{value: {seed: measure}}"""
        found = collections.defaultdict(dict)
        for row in self.rows[QUALITY]:
            if (row["kind"], row["scene"], row["movement"], row["preset"]) == (
                    kind, scene, movement, preset):
                found[float(row["value"])][int(row["seed"])] = float(row[measure])
        return dict(sorted(found.items()))

    def curve(self, kind, scene, movement, preset, measure="ssim"):
        """Values, then the mean, the lowest and the highest of the seeds of each."""
        found = self.quality(kind, scene, movement, preset, measure)
        seeds = [list(of_seeds.values()) for of_seeds in found.values()]
        return (list(found), [statistics.fmean(each) for each in seeds],
                [min(each) for each in seeds], [max(each) for each in seeds])

    def pass_times(self, scene, preset):
        """{value: {pass: milliseconds}} of the sweeps of times."""
        found = collections.defaultdict(dict)
        for row in self.rows[PASSES]:
            if (row["kind"], row["scene"], row["preset"]) == ("times", scene, preset):
                found[float(row["value"])][row["pass"]] = float(row["ms"])
        return dict(sorted(found.items()))

    def mean_passes(self, scene, preset):
        """{pass: milliseconds}, the mean of the movements, of the runs of frame rates."""
        rows = [row for row in self.rows[PASSES]
                if (row["kind"], row["scene"], row["preset"]) == ("rates", scene, preset)]
        movements = {row["movement"] for row in rows}
        sums = collections.Counter()
        for row in rows:
            # A pass that one movement does not have took no time there.
            sums[row["pass"]] += float(row["ms"]) / len(movements)
        return sums

    def rates(self, scene, preset):
        """(max, avg, min) frames per second over both movements, or None."""
        rows = [row for row in self.rows[TIMES]
                if (row["kind"], row["scene"], row["preset"]) == ("rates", scene, preset)]
        if not rows:
            return None
        return (max(float(row["max_fps"]) for row in rows),
                statistics.fmean(float(row["avg_fps"]) for row in rows),
                min(float(row["min_fps"]) for row in rows))

    def over_time(self, kind, scene, preset):
        """Frame numbers and their similarity. kind: denoised or accumulated"""
        rows = [row for row in self.rows[OVER_TIME]
                if row["unit"] == f"over_time_{kind}_{scene}" and row["preset"] == preset]
        return [int(row["frame"]) for row in rows], [float(row["ssim"]) for row in rows]

    def image(self, scene, movement, row):
        """The last frame of a view of a scene. @return None where it was not measured"""
        found = sorted((self.folder / "units" / f"view_{scene}").glob(
            f"{scene}_*_{movement}_{row}.png"))
        exact = [path for path in found
                 if path.name.split("_" + movement + "_")[1] == row + ".png"]
        return exact[0] if exact else None

    def view_value(self, scene):
        rows = [row for row in self.rows[QUALITY] if row["unit"] == f"view_{scene}"]
        return float(rows[0]["value"]) if rows else None

    def scenes(self):
        return [unit.name.removeprefix("view_") for unit in self.units
                if unit.name.startswith("view_")]

    def device(self):
        return next(iter(self.runs.values()))["device"] if self.runs else "unknown"

    def seconds(self):
        """How long all measurements took."""
        return sum(json.loads((unit / DONE).read_text())["seconds"] for unit in self.units)

    def write(self, folder):
        """The rows of all units in one file each, and the settings of every row."""
        folder.mkdir(parents=True, exist_ok=True)
        for name, rows in self.rows.items():
            if not rows:
                continue
            with open(folder / name, "w", newline="", encoding="utf-8") as file:
                writer = csv.DictWriter(file, list(rows[0]), lineterminator="\n")
                writer.writeheader()
                writer.writerows(rows)
        (folder / "runs.json").write_text(json.dumps(self.runs, indent=1) + "\n")
        return [name for name, rows in self.rows.items() if rows] + ["runs.json"]
