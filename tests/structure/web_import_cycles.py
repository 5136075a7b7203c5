#!/usr/bin/env python3
"""Checks that the web client's modules and folders import each other in no circle. Imports of types
count too: they tie the files together for the reader just as much.

    web_import_cycles.py [FOLDER]    web_client/src unless another folder is given
"""

import os
import pathlib
import re
import sys

from sources import ROOT

IMPORT = re.compile(r'\b(?:from|import)\s*\(?\s*"(\.{1,2}/[^"]+)"')
COMMENT = re.compile(r"//[^\n]*|/\*.*?\*/", re.DOTALL)
FEWEST_FILES = 40


def imports_of(path):
    """The files that a module imports by a relative path."""
    for target in IMPORT.findall(COMMENT.sub("", path.read_text())):
        yield pathlib.Path(os.path.normpath(path.parent / target))


def circles(graph):
    """The strongly connected components of more than one node (Tarjan 1972), largest first."""
    index, low, stack, found = {}, {}, [], []

    def visit(node):
        index[node] = low[node] = len(index)
        stack.append(node)
        for target in sorted(graph[node]):
            if target not in index:
                visit(target)
            if target in stack:
                low[node] = min(low[node], low[target])
        if low[node] == index[node]:
            component = []
            while not component or component[-1] != node:
                component.append(stack.pop())
            if len(component) > 1 or node in graph[node]:
                found.append(component)

    for node in sorted(graph):
        if node not in index:
            visit(node)
    return sorted(found, key=len, reverse=True)


def cycle_through(graph, component):
    """One cycle inside a strongly connected component, ending where it begins."""
    inside, path = set(component), [min(component)]
    while True:
        step = min(graph[path[-1]] & inside)
        if step in path:
            return path[path.index(step):] + [step]
        path.append(step)


def folder_graph(graph, folder):
    """The imports between folders. A folder and the ones inside it count apart."""
    folders = {}
    for path, targets in graph.items():
        own = folders.setdefault(path.parent, set())
        own |= {target.parent for target in targets} - {path.parent}
    return folders


def report(kind, graph, folder):
    lines = []
    for component in circles(graph):
        names = [str(path.relative_to(folder)) for path in cycle_through(graph, component)]
        lines.append(f"{len(component)} {kind} in a circle: " + " -> ".join(names))
    return lines


def main():
    folder = pathlib.Path(sys.argv[1]).resolve() if len(sys.argv) > 1 else ROOT / "web_client/src"
    files = set(folder.rglob("*.ts"))
    if len(files) < FEWEST_FILES:
        print(f"only {len(files)} files found: the check looks in the wrong place")
        return 1
    graph = {path: {target for target in imports_of(path)} for path in files}
    missing = [f"{path.relative_to(folder)} imports {target}, which does not exist"
               for path, targets in graph.items() for target in targets - files]
    graph = {path: targets & files for path, targets in graph.items()}
    faults = missing + report("files", graph, folder)
    faults += report("folders", folder_graph(graph, folder), folder)
    print("\n".join(faults) if faults else f"{len(files)} files: no circle of imports")
    return 1 if faults else 0


sys.exit(main())
