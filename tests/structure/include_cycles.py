#!/usr/bin/env python3
"""Checks that few units include each other in a circle. A unit is x.cpp with x.hpp: what a reader
opens together. Header guards hide such circles from the compiler."""

import collections
import pathlib
import sys

from sources import INCLUDE, ROOT, circles, report, sources

LARGEST = 6  # units in one circle


def unit_of(path: pathlib.Path) -> pathlib.Path:
    return path.relative_to(ROOT).with_suffix("")


def resolve(name: str, path: pathlib.Path):
    for base in (path.parent, ROOT / "server", ROOT):
        if (base / name).is_file():
            return (base / name).resolve()
    return None


def dependencies(files):
    edges = collections.defaultdict(set)
    for path in files:
        for name in INCLUDE.findall(path.read_text()):
            target = resolve(name, path)
            if target and unit_of(target) != unit_of(path):
                edges[unit_of(path)].add(unit_of(target))
    return edges


files = sources("protocol", "server", "shaders")
found = circles(dependencies(files))
faults = [f"{len(circle)} units include each other in a circle: " + ", ".join(map(str, circle))
          for circle in found if len(circle) > LARGEST]
largest = max(map(len, found), default=1)
sys.exit(report(files, 400, faults, f"no circle of includes has more than {LARGEST} units; "
                                    f"the largest has {largest}"))
