#!/usr/bin/env python3
"""Applies each mutant (a known mistake of other renderers) to a copy of this source, and checks
that its tests fail.

    python3 tests/mutants/run.py --work /var/tmp/mutants [--only 3 4a ...]

The copy is of what is committed. It is built whole once and then little by little; what was built
stays in the folder for the next time. Exits with 1 if a mutant is not caught."""

import argparse
import os
import pathlib
import re
import subprocess
import sys
import time

sys.path.insert(0, str(pathlib.Path(__file__).parent))
from mistakes import MISTAKES  # noqa: E402

ROOT = pathlib.Path(__file__).resolve().parents[2]
PROGRAMS = ("shader_tests", "gpu_tests", "image_tests")


def run(*command, **options):
    return subprocess.run(command, text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                          **options)


def must(*command, **options):
    done = run(*command, **options)
    if done.returncode:
        sys.exit(f"{' '.join(map(str, command))} failed:\n{done.stdout[-4000:]}")
    return done.stdout


def prepare(work):
    """A clean copy of the last commit in `work`/source, built in `work`/build."""
    source = work / "source"
    build = source / "build"
    if not source.exists():
        must("git", "clone", "--quiet", ROOT, source)
    commit = must("git", "-C", ROOT, "rev-parse", "HEAD").strip()
    must("git", "-C", source, "fetch", "--quiet", ROOT, commit)
    must("git", "-C", source, "checkout", "--quiet", "--force", commit)
    must("cmake", "-S", source, "-B", build, "-G", "Ninja", "-DCMAKE_BUILD_TYPE=RelWithDebInfo",
         "-DHELIOGRAPH_TESTS=ON")
    must("ninja", "-C", build, *PROGRAMS)
    return source, build


def test(build, mistake):
    """Names of the mutant's tests that ran, and of those that failed."""
    binary = next(build.rglob(mistake.program))
    kernels = "on" if mistake.host_kernels else "off"
    environment = {**os.environ, "HELIOGRAPH_TEST_HOST_KERNELS": kernels}
    done = run(binary, f"--gtest_filter={mistake.tests}", cwd=build, env=environment, timeout=600)
    ran = re.findall(r"^\[ RUN +\] (\S+)", done.stdout, re.MULTILINE)
    ok = re.findall(r"^\[ +OK \] (\S+)", done.stdout, re.MULTILINE)
    skipped = re.findall(r"^\[ +SKIPPED \] (\S+) \(", done.stdout, re.MULTILINE)
    return ran, [name for name in ran if name not in ok and name not in skipped]


def mistaken(source, mistake):
    """The file's text with the mutation."""
    text = (source / mistake.file).read_text()
    for old, new in ((mistake.old, mistake.new), *mistake.more):
        if text.count(old) != 1:
            sys.exit(f"{mistake.number}: {mistake.file} does not contain exactly once: {old}")
        text = text.replace(old, new)
    return text


def judge(source, build, mistake):
    """Whether the tests pass without the mutation and fail with it, and a message."""
    must("ninja", "-C", build, mistake.program)
    ran, failed = test(build, mistake)
    if not ran or failed:
        return False, f"without it {len(ran)} tests run, of which fail: {' '.join(failed) or 'none'}"
    file = source / mistake.file
    before = file.read_text()
    file.write_text(mistaken(source, mistake))
    try:
        must("ninja", "-C", build, mistake.program)
        _, failed = test(build, mistake)
    finally:
        file.write_text(before)
    return bool(failed), " ".join(failed) or "all tests pass"


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("--work", type=pathlib.Path, required=True, help="folder of the copy")
    parser.add_argument("--only", nargs="*", help="numbers of mutants")
    arguments = parser.parse_args()
    arguments.work.mkdir(parents=True, exist_ok=True)
    source, build = prepare(arguments.work.resolve())
    selected = [mistake for mistake in MISTAKES
              if not arguments.only or mistake.number in arguments.only]
    for mistake in selected:
        mistaken(source, mistake)  # fail early if the list is stale
    passed = []
    for mistake in selected:
        start = time.monotonic()
        found, message = judge(source, build, mistake)
        print(f"{mistake.number:4} {'caught' if found else 'MISSED'} {mistake.what}: {message} "
              f"({time.monotonic() - start:.0f} s)", flush=True)
        if not found:
            passed.append(mistake.number)
    if passed:
        sys.exit("mutants that no test caught: " + ", ".join(passed))


if __name__ == "__main__":
    main()
