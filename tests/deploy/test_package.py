"""The Debian packages: installation on a bare system, operation, complete removal."""

import filecmp
import os
import re
import shutil
import signal
import subprocess
import tempfile
import time
import unittest
import urllib.request

from harness import packages
from harness.commands import run, succeeds
from harness.files import text_of
from harness.image_comparison import SAME_IMAGE, largest_difference_of_means, render
from harness.servers import free_port
from harness.system import System, check_machine, release_of_this_machine

# Backups that groupadd makes of the files that it changes.
COPIES_OF_GROUPS = {"etc/group-", "etc/gshadow-"}


class Installed(unittest.TestCase):
    def test_the_unit_names_the_installed_configuration(self):
        """Also without a package, with `cmake --install`."""
        for prefix, settings in (("/usr/local", "/usr/local/etc"), ("/usr", "/etc")):
            with self.subTest(prefix), tempfile.TemporaryDirectory(dir="/var/tmp") as folder:
                run("cmake", "--install", os.environ["HELIOGRAPH_BUILD"], "--prefix", prefix,
                    env={**os.environ, "DESTDIR": folder}, timeout=300)
                unit = text_of(f"{folder}{prefix}/lib/systemd/system/heliograph.service")
                named = set(re.findall(r"\S*?(/[\w/]*/heliograph)/(?:heliograph.toml|environment)\b",
                                       unit))
                self.assertEqual(named, {f"{settings}/heliograph"})
                self.assertTrue(os.path.exists(f"{folder}{settings}/heliograph/heliograph.toml"))


class Reproducible(unittest.TestCase):
    def test_two_packages_of_a_build_have_the_same_bytes(self):
        with tempfile.TemporaryDirectory(dir="/var/tmp") as folder:
            made = [packages.of_this_build(os.path.join(folder, name)) for name in ("one", "two")]
            self.assertTrue(filecmp.cmp(*made, shallow=False))

    def test_the_umask_does_not_close_its_folders(self):
        before = os.umask(0o077)
        try:
            with tempfile.TemporaryDirectory(dir="/var/tmp") as folder:
                listed = run("dpkg-deb", "--contents", packages.of_this_build(folder))
        finally:
            os.umask(before)
        self.assertEqual([line for line in listed.splitlines()
                          if not line.startswith(("drwxr-xr-x", "-rw-r--r--", "-rwxr-xr-x"))], [])


class PackageTest:
    """Tests of every package; `suite` and `package` select it."""

    @classmethod
    def setUpClass(cls):
        check_machine()
        cls.work = tempfile.mkdtemp(prefix="heliograph-package-", dir="/var/tmp")
        cls.addClassCleanup(shutil.rmtree, cls.work, ignore_errors=True)
        cls.choose()
        cls.system = System.unpack(cls.suite, os.path.join(cls.work, "root"))
        cls.system.run("apt-get", "update")
        print(f"package: {os.path.getsize(cls.package) / 1e6:.1f} MB for {cls.suite}", flush=True)

    def test_has_complete_metadata(self):
        fields = run("dpkg-deb", "--field", self.package)
        self.assertRegex(fields, r"Depends: .*libvulkan1.*libc6.*libembree")
        listed = run("dpkg-deb", "--contents", self.package)
        self.assertNotRegex(listed, r"(?m)^[-d]rws|^[-d]......s|^-.......w")
        for path in ("usr/bin/heliograph", "usr/share/doc/heliograph/copyright",
                     "usr/share/doc/heliograph/heliograph.spdx.json",
                     "usr/lib/systemd/system/heliograph.service", "etc/heliograph/heliograph.toml",
                     "usr/share/heliograph/nvidia_icd.json"):
            self.assertIn(f"./{path}\n", listed + "\n")

    def test_installs_runs_and_is_removed_completely(self):
        system = self.system
        # Drivers and libraries were installed before it and remain.
        system.install("mesa-vulkan-drivers", *packages.dependencies(self.package))
        before, groups = system.files(), self.groups()
        system.install(self.package)
        self.assertIn("usr/bin/heliograph", system.files())
        self.renders_as_on_the_host()
        self.serves()
        system.run("apt-get", "purge", "--yes", "heliograph")
        self.assertEqual((system.files() ^ before) - COPIES_OF_GROUPS, set())
        # The unit's group remains if udev had not created it, as groups do: it may own files.
        self.assertEqual(self.groups() - groups, {"render"})

    def groups(self):
        return {line.split(":")[0] for line in self.system.run("cat", "/etc/group").splitlines()}

    def renders_as_on_the_host(self):
        scene = "/usr/share/heliograph/scenes/glossy_sponza_1.glb"
        self.system.run("heliograph", "render", scene, "-o", "/tmp/inside.png", "--width", "160",
                        "--height", "90", "--samples", "64")
        outside = os.path.join(self.work, "outside.png")
        render(self.system.path(scene), outside, samples=64)
        difference = largest_difference_of_means(self.system.path("/tmp/inside.png"), outside)
        print(f"package: at most {difference:.2f} of 255 from the host's image", flush=True)
        self.assertLess(difference, SAME_IMAGE)

    def serves(self):
        """Serves for a while as a user without privileges."""
        port = free_port()
        server = subprocess.Popen(self.system.command(
            "setpriv", "--reuid=65534", "--regid=65534", "--clear-groups", "--no-new-privs", "env",
            "XDG_CACHE_HOME=/tmp/cache", "heliograph", "serve", "--port", str(port), "--width",
            "160", "--height", "90"))
        try:
            address = f"http://127.0.0.1:{port}"
            deadline = time.monotonic() + 300
            while not succeeds(*self.system.command("heliograph", "health", "--url",
                                                    f"{address}/health/ready")):
                self.assertIsNone(server.poll(), "the server ended")
                self.assertLess(time.monotonic(), deadline)
                time.sleep(0.3)
            image = f"{address}/api/v1/sessions/main/frame.jpg?samples=1"
            with urllib.request.urlopen(image) as answer:
                self.assertEqual(answer.read(3), b"\xff\xd8\xff")
        finally:
            server.send_signal(signal.SIGTERM)
            self.assertEqual(server.wait(timeout=20), 0)


class OfThisBuild(PackageTest, unittest.TestCase):
    @classmethod
    def choose(cls):
        cls.suite = release_of_this_machine()
        cls.package = packages.of_this_build(cls.work)


class OfTheImage(PackageTest, unittest.TestCase):
    @classmethod
    def choose(cls):
        cls.suite = "trixie"
        cls.package = packages.of_the_image()


if __name__ == "__main__":
    unittest.main()
