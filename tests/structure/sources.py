"""What the checks of this folder share: the files of the project and how faults are reported."""

import pathlib
import re
import subprocess

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
