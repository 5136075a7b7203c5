"""What the checks of this folder share: the files of the project and how faults are reported."""

import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
INCLUDE = re.compile(r'^\s*#\s*include\s+"([^"]+)"', re.MULTILINE)


def tracked(*patterns):
    """Files of the project that match the patterns of `git ls-files`, with those not yet added."""
    listed = subprocess.run(
        ["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard", "--", *patterns],
        cwd=ROOT, capture_output=True, check=True, text=True).stdout
    return [ROOT / name for name in sorted(set(listed.split("\0"))) if name and (ROOT / name).is_file()]


def sources(*tops):
    """C++ files below the folders `tops`."""
    return [path for top in tops for pattern in ("*.hpp", "*.cpp", "*.h")
            for path in (ROOT / top).rglob(pattern) if "node_modules" not in path.parts]


def report(files, least, faults, fine):
    """Prints the faults, or that all is fine. Returns the exit status: 1 with faults, and where fewer
    than `least` files were found, since the check then looks in the wrong place."""
    if len(files) < least:
        print(f"only {len(files)} files found: the check looks in the wrong place")
        return 1
    print("\n".join(faults) if faults else f"{len(files)} files: {fine}")
    return 1 if faults else 0


def check(tops, least, faults_of, fine):
    """`report` for a check that looks at one C++ file after the other."""
    files = [path for path in sources(*tops) if path.suffix != ".h"]
    return report(files, least, [line for path in files for line in faults_of(path)], fine)


def circles(edges):
    """Strongly connected components of more than one node, largest first (Tarjan 1972)."""
    index, low, stack, found = {}, {}, [], []

    def visit(node):
        index[node] = low[node] = len(index)
        stack.append(node)
        for target in edges.get(node, ()):
            if target not in index:
                visit(target)
            if target in stack:
                low[node] = min(low[node], low[target])
        if low[node] == index[node]:
            circle = []
            while not circle or circle[-1] != node:
                circle.append(stack.pop())
            if len(circle) > 1:
                found.append(sorted(circle))

    sys.setrecursionlimit(10000)
    for node in sorted(edges):
        if node not in index:
            visit(node)
    return sorted(found, key=len, reverse=True)
