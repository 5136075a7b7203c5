"""What the checks of this folder share: the source files, and how what is wrong in them is told."""

import pathlib

ROOT = pathlib.Path(__file__).resolve().parents[2]


def check(tops, least, faults_of, fine):
    """Prints the lines that `faults_of` gives for the files below the folders `tops`, or that all is
    fine. Gives the exit status, 1 also where fewer than `least` files are found."""
    files = [path for top in tops for pattern in ("*.hpp", "*.cpp")
             for path in (ROOT / top).rglob(pattern) if "node_modules" not in path.parts]
    if len(files) < least:
        print(f"only {len(files)} files found: the check looks in the wrong place")
        return 1
    found = [line for path in files for line in faults_of(path)]
    print("\n".join(found) if found else f"{len(files)} files: {fine}")
    return 1 if found else 0
