#!/usr/bin/env python3
"""Checks that no folder holds more source files than a reader can take in at a glance."""

import collections
import sys

from sources import ROOT, report, tracked

MOST = 26
KINDS = ("*.cpp", "*.hpp", "*.h", "*.glsl", "*.comp", "*.frag", "*.vert", "*.rgen", "*.ts", "*.py",
         "*.mjs", "*.css")

files = tracked(*KINDS)
sizes = collections.Counter(path.parent.relative_to(ROOT) for path in files)
faults = [f"{folder}: {size} source files; at most {MOST} are allowed: make folders by purpose"
          for folder, size in sizes.most_common() if size > MOST]
sys.exit(report(files, 800, faults, f"no folder has more than {MOST} source files"))
