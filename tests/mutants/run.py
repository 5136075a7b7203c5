#!/usr/bin/env python3
"""Makes the mistakes of other renderers, one after the other, in a copy of this source, and checks
that the test which is there for each of them fails.

    python3 tests/mutants/run.py --work /var/tmp/mutants [--only 3 4a ...]

The copy is of what is committed. It is built whole once and then little by little; what was built
stays in the folder for the next time. Ends with 1 if a test lets a mistake pass."""

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
    """What GoogleTest says of the mistake's tests: those that ran and those that failed."""
    binary = next(build.rglob(mistake.program))
    kernels = "on" if mistake.host_kernels else "off"
    environment = {**os.environ, "HELIOGRAPH_TEST_HOST_KERNELS": kernels}
    done = run(binary, f"--gtest_filter={mistake.tests}", cwd=build, env=environment, timeout=600)
    ran = re.findall(r"^\[ RUN +\] (\S+)", done.stdout, re.MULTILINE)
    ok = re.findall(r"^\[ +OK \] (\S+)", done.stdout, re.MULTILINE)
    skipped = re.findall(r"^\[ +SKIPPED \] (\S+) \(", done.stdout, re.MULTILINE)
    return ran, [name for name in ran if name not in ok and name not in skipped]


def mistaken(source, mistake):
    """The file's text with the mistake."""
    text = (source / mistake.file).read_text()
    for old, new in ((mistake.old, mistake.new), *mistake.more):
        if text.count(old) != 1:
            sys.exit(f"{mistake.number}: {mistake.file} has not once: {old}")
        text = text.replace(old, new)
    return text


def judge(source, build, mistake):
    """Whether the tests pass without the mistake and fail with it, and which do."""
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
    return bool(failed), " ".join(failed) or "every test passes"


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("--work", type=pathlib.Path, required=True, help="folder of the copy")
    parser.add_argument("--only", nargs="*", help="numbers of mistakes")
    arguments = parser.parse_args()
    arguments.work.mkdir(parents=True, exist_ok=True)
    source, build = prepare(arguments.work.resolve())
    wanted = [mistake for mistake in MISTAKES
              if not arguments.only or mistake.number in arguments.only]
    for mistake in wanted:
        mistaken(source, mistake)  # a list that has gone stale ends this at once
    passed = []
    for mistake in wanted:
        start = time.monotonic()
        found, says = judge(source, build, mistake)
        print(f"{mistake.number:4} {'found ' if found else 'PASSED'} {mistake.what}: {says} "
              f"({time.monotonic() - start:.0f} s)", flush=True)
        if not found:
            passed.append(mistake.number)
    if passed:
        sys.exit("mistakes that no test noticed: " + ", ".join(passed))


if __name__ == "__main__":
    main()
