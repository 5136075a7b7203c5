"""Runs programs; the error of a failed one contains its output."""

import os
import shutil
import subprocess
import unittest


class Skip(unittest.SkipTest):
    """The reason why a test cannot run on this machine. A failure with REQUIRE_CONTAINERS=1."""


class OutOfReach(Skip):
    """A requirement that no package of this machine provides, such as another distribution's
    archive. Never a failure, but reported at the end of every run."""

    MARK = "out of reach: "

    def __str__(self):
        return self.MARK + super().__str__()


def run(*command, timeout=120, check=True, **options):
    """Returns the standard output without the last line break."""
    done = subprocess.run([str(word) for word in command], stdout=subprocess.PIPE,
                          stderr=subprocess.PIPE, text=True, timeout=timeout, **options)
    if check and done.returncode != 0:
        words = " ".join(str(word) for word in command)
        raise RuntimeError(f"{words}: exit code {done.returncode}\n"
                           f"{done.stdout[-4000:]}{done.stderr[-4000:]}")
    return done.stdout.rstrip("\n")


def succeeds(*command, **options):
    try:
        run(*command, **options)
        return True
    except (RuntimeError, OSError, subprocess.TimeoutExpired):
        return False


def program(name):
    """The distribution's program, even if another one of that name precedes it in PATH."""
    found = shutil.which(name, path="/usr/bin:/usr/sbin:" + os.environ.get("PATH", ""))
    if not found:
        raise Skip(f"{name} is not installed (deploy/setup.sh deploy installs what is needed)")
    return found
