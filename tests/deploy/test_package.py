"""The Debian package: installs into a bare system, runs there and leaves nothing behind."""

import glob
import os
import shutil
import signal
import subprocess
import tempfile
import time
import unittest
import urllib.request

from harness.commands import Skip, run, succeeds
from harness.images import bootstrap
from harness.pictures import largest_difference_of_means, render

# What apt, dpkg and the loader keep of every installation, and what is no file of the system.
TRACES = ("var/lib/dpkg/", "var/cache/", "var/log/", "var/lib/apt/", "var/lib/systemd/", "tmp/",
          "proc/", "dev/", "sys/", "run/", "etc/ld.so.cache", "etc/resolv.conf", "var/lib/pam/")


class System:
    """A folder with a Debian in it. Mounts are private to each command, so that none stay."""

    def __init__(self, folder):
        self.folder = folder

    def command(self, *words):
        script = ('mount -t proc proc "$0/proc" && mount --rbind /dev "$0/dev" && '
                  'cp /etc/resolv.conf "$0/etc/resolv.conf" && exec chroot "$0" "$@"')
        return ["unshare", "--mount", "--propagation", "private", "sh", "-c", script, self.folder,
                *words]

    def run(self, *words, timeout=300):
        return run(*self.command("env", "DEBIAN_FRONTEND=noninteractive", "LC_ALL=C.UTF-8",
                                 "XDG_CACHE_HOME=/tmp/cache", *words),
                   timeout=timeout)

    def files(self):
        found = set()
        for folder, folders, names in os.walk(self.folder):
            for name in folders + names:
                path = os.path.relpath(os.path.join(folder, name), self.folder)
                if not (path + "/").startswith(TRACES) and not path.startswith(TRACES):
                    found.add(path)
        return found


class Package(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        if os.geteuid() != 0:
            raise Skip("packages are installed by root")
        if not succeeds("unshare", "--mount", "true"):
            raise Skip("new namespaces are forbidden here")
        cls.work = tempfile.mkdtemp(prefix="heliograph-package-", dir="/var/tmp")
        cls.addClassCleanup(shutil.rmtree, cls.work, ignore_errors=True)
        run("cpack", "--config", os.path.join(os.environ["HELIOGRAPH_BUILD"], "CPackConfig.cmake"),
            "-B", cls.work, timeout=600)
        cls.package, = glob.glob(os.path.join(cls.work, "*.deb"))
        release = dict(line.split("=", 1) for line in run("cat", "/etc/os-release").splitlines())
        root = os.path.join(cls.work, "root")
        bootstrap(release["VERSION_CODENAME"], root, "directory")
        cls.system = System(root)
        cls.system.run("apt-get", "update")

    def test_has_what_a_package_needs(self):
        fields = run("dpkg-deb", "--field", self.package)
        self.assertRegex(fields, r"Depends: .*libvulkan1.*libc6.*libembree")
        listed = run("dpkg-deb", "--contents", self.package)
        self.assertNotRegex(listed, r"(?m)^[-d]rws|^[-d]......s|^-.......w")
        for path in ("usr/bin/heliograph", "usr/share/doc/heliograph/copyright",
                     "usr/lib/systemd/system/heliograph.service", "etc/heliograph/heliograph.toml"):
            self.assertIn(f"./{path}\n", listed + "\n")

    def test_installs_runs_and_goes_without_trace(self):
        system = self.system
        # Its drivers and libraries stay when it goes: they came first.
        depends = run("dpkg-deb", "--field", self.package, "Depends")
        names = [entry.split()[0] for entry in depends.split(",")]
        system.run("apt-get", "install", "--yes", "--no-install-recommends", "mesa-vulkan-drivers",
                   *names, timeout=900)
        before = system.files()
        shutil.copy(self.package, os.path.join(system.folder, "tmp/heliograph.deb"))
        system.run("apt-get", "install", "--yes", "--no-install-recommends", "/tmp/heliograph.deb")
        self.assertIn("usr/bin/heliograph", system.files())
        self.renders_as_on_the_host()
        self.serves()
        system.run("apt-get", "purge", "--yes", "heliograph")
        self.assertEqual(system.files() ^ before, set())

    def renders_as_on_the_host(self):
        self.system.run("heliograph", "render", "/usr/share/heliograph/scenes/glossy_sponza_1.glb",
                        "-o", "/tmp/inside.png", "--width", "160", "--height", "90", "--samples", "64")
        scene = os.path.join(self.system.folder, "usr/share/heliograph/scenes/glossy_sponza_1.glb")
        outside = os.path.join(self.work, "outside.png")
        render(scene, outside, samples=64)
        self.assertLess(largest_difference_of_means(
            os.path.join(self.system.folder, "tmp/inside.png"), outside), 2.0)

    def serves(self):
        """As a user without rights, for a while."""
        server = subprocess.Popen(self.system.command(
            "setpriv", "--reuid=65534", "--regid=65534", "--clear-groups", "--no-new-privs", "env",
            "XDG_CACHE_HOME=/tmp/cache", "heliograph", "serve", "--port", "8471", "--width", "160",
            "--height", "90"))
        try:
            address = "http://127.0.0.1:8471"
            deadline = time.monotonic() + 120
            while not succeeds(*self.system.command("heliograph", "health", "--url",
                                                    f"{address}/health/ready")):
                self.assertIsNone(server.poll(), "the server ended")
                self.assertLess(time.monotonic(), deadline)
                time.sleep(0.3)
            with urllib.request.urlopen(f"{address}/api/v1/sessions/main/frame.jpg") as answer:
                self.assertEqual(answer.read(3), b"\xff\xd8\xff")
        finally:
            server.send_signal(signal.SIGTERM)
            self.assertEqual(server.wait(timeout=20), 0)


if __name__ == "__main__":
    unittest.main()
