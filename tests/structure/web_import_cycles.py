#!/usr/bin/env python3
"""Checks that neither files nor folders of the web client import each other in a circle. Imports of
types count, too: a reader must open both files.

    web_import_cycles.py [FOLDER]    web_client/src unless another folder is given
"""

import os
import pathlib
import re
import sys

from sources import ROOT, circles, report

IMPORT = re.compile(r'\b(?:from|import)\s*\(?\s*"(\.{1,2}/[^"]+)"')
COMMENT = re.compile(r"//[^\n]*|/\*.*?\*/", re.DOTALL)


def imports_of(path):
    """The files that a module imports by a relative path."""
    for target in IMPORT.findall(COMMENT.sub("", path.read_text())):
        yield pathlib.Path(os.path.normpath(path.parent / target))


def cycle_through(graph, component):
    """One cycle inside a strongly connected component; its last node is the first."""
    path = [min(component)]
    while True:
        step = min(graph[path[-1]] & component)
        if step in path:
            return path[path.index(step):] + [step]
        path.append(step)


def folder_graph(graph):
    """The imports between folders. A folder and its sub-folders are separate nodes."""
    folders = {}
    for path, targets in graph.items():
        own = folders.setdefault(path.parent, set())
        own |= {target.parent for target in targets} - {path.parent}
    return folders


def faults_of(kind, graph, folder):
    for component in circles(graph):
        names = [str(path.relative_to(folder)) for path in cycle_through(graph, set(component))]
        yield f"{len(component)} {kind} import each other in a circle: " + " -> ".join(names)


folder = pathlib.Path(sys.argv[1]).resolve() if len(sys.argv) > 1 else ROOT / "web_client/src"
files = set(folder.rglob("*.ts"))
graph = {path: set(imports_of(path)) for path in files}
faults = [f"{path.relative_to(folder)} imports {target}, which does not exist"
          for path, targets in graph.items() for target in targets - files]
graph = {path: targets & files for path, targets in graph.items()}
faults += [*faults_of("files", graph, folder), *faults_of("folders", folder_graph(graph), folder)]
sys.exit(report(files, 40, faults, "no file and no folder imports itself through others"))
