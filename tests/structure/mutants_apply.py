#!/usr/bin/env python3
"""Checks that the mutants (tests/mutants/mistakes.py) can still be made: the text that each replaces is
in its file exactly once, and the tests that must notice it exist."""

import fnmatch
import re
import sys

from sources import ROOT, report, tracked

sys.path.insert(0, str(ROOT / "tests/mutants"))
from mistakes import MISTAKES  # noqa: E402

FOLDERS = {"shader_tests": "tests/shader", "gpu_tests": "tests/gpu", "image_tests": "tests/image"}
TEST = re.compile(r"^TEST(?:_[FP])?\(\s*(\w+),\s*(\w+)\s*\)", re.MULTILINE)


def tests_of(program):
    """Names of the program's tests, "Suite.Name"."""
    return {".".join(names) for path in tracked(f"{FOLDERS[program]}/*.cpp")
            for names in TEST.findall(path.read_text())}


def selects(pattern, name):
    """Whether a part of a GoogleTest filter can select the test: "*Suite.Name/*" stands for the
    instances of a parameterized test."""
    return fnmatch.fnmatchcase(name, re.sub(r"^\*|/[^/]*$", "", pattern))


def faults_of(mistake, tests):
    path = ROOT / mistake.file
    if not path.is_file():
        yield f"mutant {mistake.number}: there is no {mistake.file}"
        return
    text = path.read_text()
    for old, _ in ((mistake.old, mistake.new), *mistake.more):
        count = text.count(old)
        if count != 1:
            yield f"mutant {mistake.number}: {mistake.file} has {count} times, not once: {old}"
    for pattern in mistake.tests.split(":"):
        if not any(selects(pattern, name) for name in tests):
            yield f"mutant {mistake.number}: {mistake.program} has no test {pattern}"


tests = {program: tests_of(program) for program in FOLDERS}
faults = [fault for mistake in MISTAKES for fault in faults_of(mistake, tests[mistake.program])]
sys.exit(report(MISTAKES, 25, faults, "every mutant applies and its tests exist"))
