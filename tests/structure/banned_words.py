#!/usr/bin/env python3
"""Checks that no text of the project uses a word of banned_words.txt: what a graphics engineer would
search for must be found."""

import pathlib
import re
import sys

from sources import ROOT, report, tracked

LIST = pathlib.Path(__file__).with_name("banned_words.txt")
SKIPPED = {".png", ".jpg", ".svg", ".hdr", ".inc", ".lock"}
SKIPPED_NAMES = {"banned_words.txt", "package-lock.json", "LICENSE"}
# snake_case and camelCase are words too: "frames_kept", "framesKept".
PARTS = re.compile(r"(?<=[a-z])(?=[A-Z])|_")


def read_list():
    rules = []
    for line in LIST.read_text().splitlines():
        if not line or line.startswith("#"):
            continue
        if line.startswith("allow "):
            rules[-1][2] = re.compile(line[len("allow "):], re.IGNORECASE)
            continue
        words, use = re.split(r"\s{2,}", line, maxsplit=1)
        rules.append([re.compile(rf"\b({words})\b", re.IGNORECASE), use, None])
    return rules


def faults_of(path, rules):
    for number, line in enumerate(path.read_text(errors="replace").splitlines(), 1):
        text = PARTS.sub(" ", line)
        for pattern, use, allowed in rules:
            kept = allowed.sub("", line) if allowed else line
            match = pattern.search(text if kept == line else PARTS.sub(" ", kept))
            if match:
                yield f'{path.relative_to(ROOT)}:{number}: "{match.group(0)}": {use}'


rules = read_list()
files = [path for path in tracked() if path.suffix not in SKIPPED and path.name not in SKIPPED_NAMES]
sys.exit(report(files, 900, [fault for path in files for fault in faults_of(path, rules)],
                "no banned words"))
