"""The committed files, as the image builder sees them."""

import fnmatch
import hashlib
import os
import subprocess

from .commands import run
from .files import DEPLOY, ROOT, text_of


def clone(path):
    """Copies all committed files into a new folder."""
    run("git", "clone", "--quiet", "--depth", "1", f"file://{ROOT}", path)


class Checkout:
    """The committed files of a folder; for the whole repository without those excluded by
    .dockerignore."""

    def __init__(self, folder=""):
        self._tree = f"HEAD:{folder}"
        ignored = os.path.join(DEPLOY, "Dockerfile.dockerignore")
        self._left_out = [] if folder else text_of(ignored).split()

    def write(self, file):
        """A tar archive of the files, from which the builder would exclude nothing."""
        subprocess.run(["git", "-C", ROOT, "archive", self._tree], stdout=file, check=True)

    def files(self):
        return list(self._objects())

    def key(self):
        """A digest that changes with any file."""
        lines = "\n".join(f"{path} {words}" for path, words in self._objects().items())
        return hashlib.sha256(lines.encode()).hexdigest()[:40]

    def _objects(self):
        lines = run("git", "-C", ROOT, "ls-tree", "-r", "--full-tree", self._tree).splitlines()
        found = (line.split("\t", 1) for line in lines)
        return {path: words for words, path in found if not self._is_left_out(path)}

    def _is_left_out(self, path):
        parts = path.split("/")
        above = ["/".join(parts[:count]) for count in range(1, len(parts) + 1)]
        return any(_matches(name, pattern) for name in above for pattern in self._left_out)


def _matches(path, pattern):
    if pattern.startswith("**/"):
        return fnmatch.fnmatch(os.path.basename(path), pattern[3:])
    return path.count("/") == pattern.count("/") and fnmatch.fnmatch(path, pattern)
