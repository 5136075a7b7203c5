"""A Debian system in a folder, in which packages are installed and programs run."""

import os
import shutil

from . import images
from .commands import Skip, run, succeeds

# State that apt, dpkg and the loader keep of installations, and files outside of the system.
TRACES = ("var/lib/dpkg/", "var/cache/", "var/log/", "var/lib/apt/", "var/lib/systemd/", "tmp/",
          "proc/", "dev/", "sys/", "run/", "etc/ld.so.cache", "etc/resolv.conf", "var/lib/pam/")


def check_machine():
    """Raises Skip if such a folder cannot be entered."""
    if os.geteuid() != 0:
        raise Skip("packages are installed by root")
    if not succeeds("unshare", "--mount", "true"):
        raise Skip("new namespaces are forbidden here")


def release_of_this_machine():
    """Its code name, such as trixie."""
    lines = run("cat", "/etc/os-release").splitlines()
    return dict(line.split("=", 1) for line in lines if "=" in line)["VERSION_CODENAME"]


class System:
    """Mounts are private to each command, so that none remain."""

    def __init__(self, folder):
        self.folder = folder

    @classmethod
    def unpack(cls, suite, folder):
        os.mkdir(folder)
        run("tar", "--extract", "--directory", folder, "--file", images.base_archive(suite))
        return cls(folder)

    def command(self, *words, binds=()):
        """`binds` are pairs of outer folders and inner paths."""
        more = "".join(f'mkdir -p "$0{inside}" && mount --bind "{outside}" "$0{inside}" && '
                       for outside, inside in binds)
        script = ('mount -t proc proc "$0/proc" && mount --rbind /dev "$0/dev" && ' + more +
                  'cp /etc/resolv.conf "$0/etc/resolv.conf" && exec chroot "$0" "$@"')
        return ["unshare", "--mount", "--propagation", "private", "sh", "-c", script, self.folder,
                *words]

    def run(self, *words, timeout=600, environment=(), binds=()):
        """Runs a command as root, with variables as NAME=VALUE."""
        return run(*self.command("env", "DEBIAN_FRONTEND=noninteractive", "LC_ALL=C.UTF-8",
                                 "XDG_CACHE_HOME=/tmp/cache", *environment, *words, binds=binds),
                   timeout=timeout)

    def install(self, *packages):
        """Installs packages by name, or a file of this machine."""
        names = []
        for package in packages:
            if os.path.isabs(package):
                shutil.copy(package, os.path.join(self.folder, "tmp"))
                package = "/tmp/" + os.path.basename(package)
            names.append(package)
        self.run("apt-get", "install", "--yes", "--no-install-recommends", *names, timeout=1800)

    def path(self, inside):
        return os.path.join(self.folder, inside.lstrip("/"))

    def files(self):
        found = set()
        for folder, folders, names in os.walk(self.folder):
            for name in folders + names:
                path = os.path.relpath(os.path.join(folder, name), self.folder)
                if not (path + "/").startswith(TRACES) and not path.startswith(TRACES):
                    found.add(path)
        return found
