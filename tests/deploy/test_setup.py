"""The README's command on bare systems: a fresh checkout becomes a running server. Everything is
downloaded and built from scratch, except for ccache."""

import os
import re
import shutil
import signal
import subprocess
import tempfile
import time
import unittest

from harness import images
from harness.commands import OutOfReach, run, succeeds
from harness.files import DEPLOY, ROOT, text_of
from harness.servers import free_port, get
from harness.system import System, check_machine

MOST_SECONDS = 3000
# As in the image's build: ccache entries depend on the language too.
ENVIRONMENT = ("PATH=/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin", "HOME=/root",
               "HELIOGRAPH_BUILD=/build")
# Of Ubuntu 24.04, for example http://archive.ubuntu.com/ubuntu; Debian's is known to apt.
UBUNTU = "HELIOGRAPH_UBUNTU_MIRROR"


def listed():
    """Every package of any purpose, and whether every release has it."""
    lines = [line.split() for line in text_of(os.path.join(DEPLOY, "packages")).splitlines()
             if line and not line.startswith("#")]
    return {words[1].removesuffix("?"): not words[1].endswith("?") for words in lines}


class SetupTest:
    suite = mirror = None

    @classmethod
    def setUpClass(cls):
        check_machine()
        cls.work = tempfile.mkdtemp(prefix="heliograph-setup-", dir="/var/tmp")
        cls.addClassCleanup(shutil.rmtree, cls.work, ignore_errors=True)
        images.base_archive(cls.suite, cls.mirror)
        cls.system = System.unpack(cls.suite, os.path.join(cls.work, "root"))
        cls.system.run("apt-get", "update")

    def test_every_listed_package_can_be_installed(self):
        had = [name for name, everywhere in listed().items() if everywhere or self.has(name)]
        self.system.run("apt-get", "install", "--simulate", "--no-install-recommends", *had)

    def has(self, package):
        return succeeds(*self.system.command("apt-cache", "show", package))

    def test_programs_of_the_deployment_tests_are_installed(self):
        folder = self.system.path("/listed")
        os.mkdir(folder)
        for name in ("packages", "setup.sh"):
            shutil.copy(os.path.join(DEPLOY, name), folder)
        self.system.run("/listed/setup.sh", "deploy", timeout=1800)
        for program in ("dockerd", "docker", "docker-compose", "podman", "runc", "curl", "iptables",
                        "ip", "mmdebstrap"):
            with self.subTest(program):
                self.system.run("sh", "-c", f"command -v {program}")
        # The server's Dockerfile needs BuildKit: a part of the program itself until version 22.
        version = int(re.search(r"version (\d+)", self.system.run("docker", "--version"))[1])
        if version > 22:
            self.system.run("docker", "buildx", "version")
        self.assertIn("every package is installed", self.system.run("/listed/setup.sh", "deploy"))

    def test_a_fresh_checkout_becomes_a_server(self):
        source = self.system.path("/src")
        os.mkdir(source)
        with subprocess.Popen(["git", "-C", ROOT, "archive", "HEAD"],
                              stdout=subprocess.PIPE) as archive:
            run("tar", "--extract", "--directory", source, stdin=archive.stdout)
        started, port = time.monotonic(), free_port()
        address = f"http://127.0.0.1:{port}/"
        # The same folder as in the image's build, so that ccache entries match.
        binds = [(images.compiler_cache(), "/root/.cache/ccache")]
        with open(os.path.join(self.work, "log"), "w+", encoding="utf-8") as log:
            server = subprocess.Popen(
                self.system.command("env", "--ignore-environment", *ENVIRONMENT,
                                    "/src/deploy/run.sh", "--port", str(port), "--width", "160",
                                    "--height", "90", binds=binds),
                stdin=subprocess.DEVNULL, stdout=log, stderr=log, start_new_session=True)
            try:
                self.wait_ready(server, log, address)
                print(f"setup: from a bare system to the first frame on {self.suite} in "
                      f"{time.monotonic() - started:.0f} s", flush=True)
                status, _, image = get(address + "api/v1/sessions/main/frame.jpg?samples=1")
                self.assertEqual((status, image[:3]), (200, b"\xff\xd8\xff"))
            finally:
                if server.poll() is None:
                    os.killpg(server.pid, signal.SIGTERM)
                server.wait(timeout=30)
        self.check_repeated_setup()

    def wait_ready(self, server, log, address):
        deadline = time.monotonic() + MOST_SECONDS
        while time.monotonic() < deadline:
            try:
                if get(address + "health/ready", timeout=5)[0] == 200:
                    return
            except OSError:
                pass  # still installing or building
            if server.poll() is not None:
                log.seek(0)
                raise AssertionError(f"run.sh ended with {server.returncode}: {log.read()[-4000:]}")
            time.sleep(0.5)
        raise AssertionError(f"no frame after {MOST_SECONDS} s")

    def check_repeated_setup(self):
        self.assertIn("every package is installed",
                      self.system.run("/src/deploy/setup.sh", "build", "run"))


class Debian13(SetupTest, unittest.TestCase):
    suite = "trixie"


class Ubuntu2404(SetupTest, unittest.TestCase):
    suite = "noble"
    mirror = os.environ.get(UBUNTU)

    @classmethod
    def setUpClass(cls):
        if not cls.mirror:
            raise OutOfReach(f"the archive of Ubuntu 24.04 ({UBUNTU} names no mirror)")
        super().setUpClass()


if __name__ == "__main__":
    unittest.main()
