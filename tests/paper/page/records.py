"""Times of other machines: a file of tests/paper/records each, which anyone can add."""

import json
import pathlib

import paper
from markup import table

FOLDER = pathlib.Path(__file__).resolve().parents[1] / "records"
PRESETS = ("reinhard", "best")


def of(results, machine, processors):
    """What this run says about the machine, in the form of a record."""
    runs = [run for unit, run in results.runs.items() if unit.startswith("rates_")]
    rates = {}
    for scene in paper.RATES:
        found = {preset: results.rates(scene, preset) for preset in PRESETS}
        found = {preset: round(rate[1], 1) for preset, rate in found.items() if rate}
        if found:
            rates[scene] = found
    return {"machine": machine, "device": results.device(), "processors": processors,
            "size": runs[0]["size"] if runs else "", "frames_per_second": rates}


def read():
    return [json.loads(path.read_text()) for path in sorted(FOLDER.glob("*.json"))]


def as_table():
    rows = []
    for record in read():
        rates = record["frames_per_second"]
        for preset in PRESETS:
            known = [rates.get(scene, {}).get(preset) for scene in paper.RATES]
            if any(known):
                rows.append((record["machine"], record["device"], record["size"], preset,
                             *("–" if rate is None else f"{rate:g}" for rate in known)))
    return table(("machine", "device", "size", "preset", *map(paper.SCENE_TITLES.get,
                                                              paper.RATES)), rows,
                 "Frames per second, mean of the animated movements")
