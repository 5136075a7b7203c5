#!/usr/bin/env python3
"""Checks that a folder includes only folders below it (ARCHITECTURE.md, "Layers")."""

import pathlib
import re
import sys

from sources import ROOT, check

# Folder -> what it may include besides itself.
BELOW = {
    "protocol": set(),
    "gpu": set(),
    "scene": {"protocol"},
    "tracing": {"gpu", "scene", "protocol"},
    "render": {"tracing", "gpu", "scene", "protocol"},
    "stream": {"protocol"},
    "jobs": {"protocol"},
    "session": {"render", "stream", "jobs", "scene", "protocol"},
    "net": {"session", "stream", "jobs", "protocol"},
    "cli": {"net", "session", "jobs", "render", "stream", "scene", "protocol"},
}
# Headers outside the folders above, and who may include them.
SHARED = {"shaders": {"scene", "tracing", "render"}, "web_client": {"net"}}
INCLUDE = re.compile(r'^\s*#\s*include\s+"([^"]+)"')
# The part of a module that other modules may include.
PUBLIC = {"render": "render/api/"}


def folder_of(path: pathlib.Path) -> str:
    parts = path.relative_to(ROOT).parts
    return parts[1] if parts[0] == "server" else parts[0]


def violations(path: pathlib.Path):
    folder = folder_of(path)
    if folder not in BELOW:
        return
    for number, line in enumerate(path.read_text().splitlines(), 1):
        match = INCLUDE.match(line)
        if not match:
            continue
        target = match.group(1).split("/")[0]
        allowed = BELOW[folder] | {folder}
        if target in BELOW and target not in allowed:
            yield f"{path.relative_to(ROOT)}:{number}: {folder} must not include {match.group(1)}"
        if target in PUBLIC and target != folder and not match.group(1).startswith(PUBLIC[target]):
            yield (f"{path.relative_to(ROOT)}:{number}: {folder} may include only {PUBLIC[target]} "
                   f"of {target}, not {match.group(1)}")
        if target in SHARED and folder not in SHARED[target]:
            yield f"{path.relative_to(ROOT)}:{number}: {folder} must not include {match.group(1)}"


sys.exit(check(("protocol", "server"), 50, violations, "every include points down"))
