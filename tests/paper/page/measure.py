"""Runs heliograph-experiments unit by unit. A unit that has finished with the same options is kept."""

import json
import pathlib
import shutil
import subprocess
import sys
import time

DONE = "done.json"


class Progress:
    """What is being measured, how much is done and how long the rest will take."""

    def __init__(self, units, output=sys.stderr):
        self.total = sum(unit.cost for unit in units)
        self.kept = 0.0
        self.finished = 0.0
        self.start = time.monotonic()
        self.output = output
        self.inline = output.isatty()

    def keep(self, unit):
        self.kept += unit.cost

    def finish(self, unit):
        self.finished += unit.cost

    def left(self, done):
        """Seconds, from the speed of what this run has measured; None before there is any."""
        measured = self.finished + done
        if measured <= 0.0:
            return None
        spent = time.monotonic() - self.start
        return spent / measured * (self.total - self.kept - measured)

    def show(self, unit, row, line):
        done = unit.cost * min(1.0, row / max(1, unit.rows))
        share = 100.0 * (self.kept + self.finished + done) / self.total
        left = self.left(done)
        rest = "" if left is None else f", {left / 60.0:.0f} min left"
        text = f"{share:3.0f} %{rest}: {unit.what}: {line}"
        end = "\r" if self.inline else "\n"
        print(f"{text[:118]:<118}" if self.inline else text, end=end, file=self.output, flush=True)


def finished(folder, unit):
    try:
        return json.loads((folder / DONE).read_text())["arguments"] == list(unit.arguments)
    except (OSError, ValueError, KeyError):
        return False


def run_unit(binary, folder, truth, unit, progress):
    """Measures into a folder beside its place, so that an interrupted unit leaves nothing there."""
    part = folder.with_suffix(".part")
    shutil.rmtree(part, ignore_errors=True)
    part.mkdir(parents=True)
    command = [str(binary), *unit.arguments, "--output", str(part), "--ground-truth-folder",
               str(truth)]
    started = time.monotonic()
    with open(part / "log.txt", "w", encoding="utf-8") as log, subprocess.Popen(
            command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True) as run:
        row, last = 0, ""
        for line in run.stderr:
            log.write(line)
            row, last = row + 1, line.strip()
            progress.show(unit, row, last)
    if run.returncode:
        raise RuntimeError(f"{unit.what}: {last or 'heliograph-experiments failed'}")
    (part / DONE).write_text(json.dumps({"arguments": list(unit.arguments),
                                         "seconds": round(time.monotonic() - started, 1)}))
    shutil.rmtree(folder, ignore_errors=True)
    part.rename(folder)


def measure(binary, units, output):
    """Measures all units below `output`/units. @return how many were measured, not kept"""
    data = pathlib.Path(output) / "units"
    truth = pathlib.Path(output) / "ground_truth"
    progress = Progress(units)
    wanted = []
    for unit in units:
        if finished(data / unit.name, unit):
            progress.keep(unit)
        else:
            wanted.append(unit)
    if len(wanted) < len(units):
        print(f"{len(units) - len(wanted)} of {len(units)} measurements are kept from before",
              file=sys.stderr)
    for unit in wanted:
        progress.show(unit, 0, "starts")
        run_unit(binary, data / unit.name, truth, unit, progress)
        progress.finish(unit)
    return len(wanted)
