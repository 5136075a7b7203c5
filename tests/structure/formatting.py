#!/usr/bin/env python3
"""Checks that clang-format would change no C++ file. Versions differ in what they do: the one of
Debian 12 decides."""

import concurrent.futures
import os
import shutil
import subprocess
import sys

from sources import ROOT, report, tracked

VERSION = "14"
SKIPPED = 77


def formatter():
    for name in (f"clang-format-{VERSION}", "clang-format"):
        path = shutil.which(name)
        if path and f"version {VERSION}." in subprocess.run(
                [path, "--version"], capture_output=True, text=True, check=True).stdout:
            return path
    return None


def faults_of(tool, files):
    run = subprocess.run([tool, "--dry-run", "--style=file", *map(str, files)], cwd=ROOT,
                         capture_output=True, text=True, check=True)
    return [line.replace(f"{ROOT}/", "") for line in run.stderr.splitlines()
            if "[-Wclang-format-violations]" in line]


tool = formatter()
if not tool:
    print(f"skipped: clang-format {VERSION} is not installed")
    sys.exit(SKIPPED)
files = tracked("*.cpp", "*.hpp", "*.h")
parts = [files[i::32] for i in range(32)]
with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
    faults = sorted(line for part in pool.map(lambda part: faults_of(tool, part), parts)
                    for line in part)
sys.exit(report(files, 600, faults, "formatted as .clang-format says"))
