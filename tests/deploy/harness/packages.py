"""The Debian packages under test."""

import glob
import os

from . import images
from .commands import run
from .site import Site


def of_this_build(folder):
    """For this machine's distribution, from the build folder."""
    run("cpack", "--config", os.path.join(os.environ["HELIOGRAPH_BUILD"], "CPackConfig.cmake"),
        "-B", folder, timeout=600)
    package, = glob.glob(os.path.join(folder, "*.deb"))
    return package


def of_the_image():
    """For Debian 13: the one installed in the image."""
    path = images.package_path()
    if not os.path.exists(path):
        with Site() as site:
            machine = site.add_machine()
            images.add_base(machine)
            images.build_server(machine)
    return path


def dependencies(package):
    depends = run("dpkg-deb", "--field", package, "Depends")
    return [entry.split()[0] for entry in depends.split(",")]
