#!/usr/bin/env python3
"""Checks that every function, struct, constant and macro of shaders/ is named a second time, in a
shader; those of shaders/shared/ in a shader or in C++. Tests do not count."""

import collections
import re
import sys

from sources import ROOT, report, tracked

COMMENT = re.compile(r"//[^\n]*|/\*.*?\*/", re.S)
WORD = re.compile(r"\b[A-Za-z_]\w*\b")
FUNCTION = re.compile(r"^[A-Za-z_]\w*[ \t]+([A-Za-z_]\w*)[ \t]*\(", re.M)
STRUCT = re.compile(r"^struct[ \t]+([A-Za-z_]\w*)", re.M)
CONSTANT = re.compile(r"^(?:const|SHARED_CONSTANT)[ \t]+\w+[ \t]+([A-Za-z_]\w*)", re.M)
MACRO = re.compile(r"^#define[ \t]+([A-Za-z_]\w*)", re.M)
# Named by the language, or only guards of a header.
EXEMPT = re.compile(r"main$|HELIOGRAPH_\w+_(?:H|GLSL)$")


def text_of(path):
    return COMMENT.sub(lambda match: "\n" * match.group().count("\n"), path.read_text())


def words_of(paths):
    return collections.Counter(word for path in paths for word in WORD.findall(text_of(path)))


def definitions_of(path):
    """Lines of each name: overloads and branches of #if define one several times."""
    found = collections.defaultdict(list)
    text = text_of(path)
    for pattern in (FUNCTION, STRUCT, CONSTANT, MACRO):
        for match in pattern.finditer(text):
            if not EXEMPT.match(match.group(1)):
                found[match.group(1)].append(text.count("\n", 0, match.start(1)) + 1)
    return found


glsl = tracked(*(f"shaders/*.{kind}" for kind in
                 ("glsl", "comp", "vert", "frag", "rgen", "rmiss", "rchit", "rahit")))
shared = tracked("shaders/shared/*.h")
in_shaders = words_of(glsl + shared)
in_cpp = words_of(tracked("server/*.cpp", "server/*.hpp"))

faults = []
defined = 0
for path in glsl + shared:
    for name, lines in definitions_of(path).items():
        defined += 1
        uses = in_shaders[name] + (in_cpp[name] if path in shared else 0)
        if uses <= len(lines):
            faults.append(f"{path.relative_to(ROOT)}:{lines[0]}: {name} is not used")

sys.exit(report(glsl + shared, 100, faults, f"{defined} definitions, all used"))
