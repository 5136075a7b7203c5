#!/usr/bin/env python3
"""Checks that the extensions of glTF that the importer takes are those of the table in
server/scene/README.md, and that it takes every extension that it reads: files that require one that
is missing there are refused, whatever the importer can do with it."""

import re
import sys

from sources import ROOT

EXTENSION = re.compile(r"\b(?:KHR|EXT)_[a-zA-Z]\w*")
SOURCES = ROOT / "server/scene/gltf"
DOCUMENT = ROOT / "server/scene/README.md"


def listed(name: str):
    """The extensions of a list in versions.cpp."""
    text = (SOURCES / "schema/versions.cpp").read_text()
    found = re.search(rf"\b{name} = \{{(.*?)\}};", text, re.DOTALL)
    return set(EXTENSION.findall(found[1])) if found else set()


def documented(support: str):
    """The extensions of the rows whose second column is `support`."""
    rows = re.findall(r"^\| ([^|]*) \| ([^|]*) \|", DOCUMENT.read_text(), re.MULTILINE)
    return {name for names, column in rows if re.fullmatch(support, column)
            for name in EXTENSION.findall(names)}


def main():
    supported, ignored = listed("supported_extensions"), listed("harmless_extensions")
    read = {name for path in SOURCES.rglob("*.[ch]pp")
            for name in re.findall(r'"((?:KHR|EXT)_\w+)"', path.read_text())}
    faults = []
    for what, code, document in (("supported", supported, documented("full|converted")),
                                 ("ignored", ignored, documented("ignored"))):
        faults += [f"{name} is {what} and not in the table of {DOCUMENT.name}"
                   for name in sorted(code - document)]
        faults += [f"{name} is {what} by the table of {DOCUMENT.name} and refused where required"
                   for name in sorted(document - code)]
    faults += [f"{name} is read and refused where required"
               for name in sorted(read - supported - ignored)]
    print("\n".join(faults) or f"{len(supported | ignored)} extensions: all in code and document")
    return 1 if faults or not supported else 0


if __name__ == "__main__":
    sys.exit(main())
