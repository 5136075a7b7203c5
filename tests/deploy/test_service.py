"""The unit on a booted systemd: start, service, stop, restart, privileges. Once with the package of
this build, once with the image's."""

import asyncio
import os
import re
import shutil
import tempfile
import time
import unittest

from harness import packages
from harness.booted import INSIDE, Booted
from harness.replaying_viewer import ReplayingViewer, ViewState
from harness.servers import TOKEN, get
from harness.system import System, check_machine, release_of_this_machine

UNIT = "heliograph.service"
URL = f"http://{INSIDE}:8080/"
MOST_EXPOSED = 1.5  # systemd's exposure score, from 0 (none) to 10


class ServiceTest:
    @classmethod
    def setUpClass(cls):
        check_machine()
        cls.work = tempfile.mkdtemp(prefix="heliograph-service-", dir="/var/tmp")
        cls.addClassCleanup(shutil.rmtree, cls.work, ignore_errors=True)
        os.chmod(cls.work, 0o755)
        cls.choose()
        system = System.unpack(cls.suite, os.path.join(cls.work, "root"))
        system.run("apt-get", "update")
        system.install("systemd", "mesa-vulkan-drivers", cls.package)
        shutil.copy(cls.package, system.path("/root/heliograph.deb"))
        cls.configure(system)
        started = time.monotonic()
        cls.booted = cls.enterClassContext(Booted(system))
        version = cls.booted.run("systemctl", "--version").split()[1]
        print(f"service: systemd {version} of {cls.suite} is up after "
              f"{time.monotonic() - started:.1f} s", flush=True)

    @staticmethod
    def configure(system):
        """As documented: secrets in a file that only root can read."""
        path = system.path("/etc/heliograph/environment")
        with open(path, "w", encoding="utf-8") as file:
            file.write(f"HELIOGRAPH_TOKEN={TOKEN}\nHELIOGRAPH_HOST=0.0.0.0\n"
                       "HELIOGRAPH_WIDTH=160\nHELIOGRAPH_HEIGHT=90\nHELIOGRAPH_DRAIN_NOTICE=1\n")
        os.chmod(path, 0o600)

    def setUp(self):
        """Every test begins with a service that is ready for viewers."""
        # Reset the start limit: starts of other tests must not count.
        self.booted.run("systemctl", "reset-failed", UNIT, check=False)
        self.systemctl("start", UNIT)
        self.wait_ready()

    def systemctl(self, *words):
        return self.booted.run("systemctl", *words)

    def properties(self, *names):
        return self.booted.properties(UNIT, *names)

    def wait_ready(self, timeout=300):
        deadline = time.monotonic() + timeout
        while True:
            try:
                if get(URL + "health/ready", timeout=5)[0] == 200:
                    return
            except OSError:
                pass  # not listening yet
            if time.monotonic() > deadline:
                raise AssertionError(self.booted.run("journalctl", "--no-pager", "--lines", "20",
                                                     "--unit", UNIT, check=False))
            time.sleep(0.1)

    def main_process(self):
        return int(self.properties("MainPID")["MainPID"])

    def test_runs_without_rights(self):
        status = self.booted.status_of(self.main_process())
        users = {int(number) for number in status["Uid"].split()}
        self.assertEqual(len(users), 1)
        self.assertIn(users.pop(), range(61184, 65520), "not a dynamic user")
        for name in ("CapInh", "CapPrm", "CapEff", "CapBnd", "CapAmb"):
            self.assertEqual(int(status[name], 16), 0, name)
        self.assertEqual(int(status["NoNewPrivs"]), 1)
        self.assertEqual(int(status["Seccomp"]), 2)

    def test_reports_health(self):
        self.booted.run("heliograph", "health")
        status, _, image = get(URL + "api/v1/sessions/main/frame.jpg?samples=1")
        self.assertEqual((status, image[:3]), (200, b"\xff\xd8\xff"))
        self.assertEqual(get(URL + "api/v1/schema", token="wrong-token-0")[0], 401)

    def test_writes_its_cache_and_nothing_else(self):
        main = self.main_process()
        probe = ("for folder in / /etc /usr /var /var/lib /srv /home /root /boot /sys/fs/cgroup "
                 "/etc/heliograph /var/cache /var/cache/heliograph /tmp; do "
                 "if (: >$folder/.probe) 2>/dev/null; then rm -f $folder/.probe; echo $folder; fi; "
                 "done; cat /etc/heliograph/environment 2>/dev/null | head -c 9")
        self.assertEqual(self.booted.run_as(main, probe).split(), ["/var/cache/heliograph", "/tmp"])
        self.assertTrue(self.booted.run("find", "/var/cache/private/heliograph", "-type", "f"),
                        "no shader was kept")

    def test_exposes_little(self):
        said = self.booted.run("systemd-analyze", "security", "--no-pager", UNIT)
        exposure = float(re.search(r"Overall exposure level for [^:]*: ([0-9.]+)", said).group(1))
        print(f"service: exposure {exposure} of 10", flush=True)
        self.assertLessEqual(exposure, MOST_EXPOSED)

    async def test_closes_viewers_when_it_is_stopped(self):
        async with ReplayingViewer(URL, TOKEN, ViewState("glossy_sponza_1")) as viewer:
            started = time.monotonic()
            await asyncio.to_thread(self.systemctl, "stop", UNIT)
            seconds = time.monotonic() - started
            await asyncio.sleep(0.2)
            self.assertEqual([loss.code for loss in viewer.losses], [1001])
        print(f"service: stopped in {seconds:.1f} s", flush=True)
        self.assertLess(seconds, 15)
        said = self.properties("ActiveState", "Result", "ExecMainStatus")
        self.assertEqual(said, {"ActiveState": "inactive", "Result": "success",
                                "ExecMainStatus": "0"})

    async def test_restarts_after_a_crash(self):
        async with ReplayingViewer(URL, TOKEN, ViewState("glossy_sponza_1")) as viewer:
            before = self.main_process()
            await asyncio.to_thread(self.systemctl, "kill", "--signal", "KILL", UNIT)
            while not viewer.losses:
                await asyncio.sleep(0.01)
            await viewer.whole(timeout=90)
            print(f"service: killed, viewer restored after {viewer.losses[0].seconds:.1f} s",
                  flush=True)
        said = self.properties("NRestarts", "ActiveState")
        self.assertEqual(said, {"NRestarts": "1", "ActiveState": "active"})
        self.assertNotEqual(self.main_process(), before)

    def test_an_upgrade_takes_effect_and_a_removal_leaves_nothing(self):
        before = self.main_process()
        self.systemctl("enable", UNIT)
        self.booted.run("dpkg", "--install", "/root/heliograph.deb", timeout=300)
        self.wait_ready()
        self.assertNotEqual(self.main_process(), before)
        self.booted.run("dpkg", "--purge", "heliograph", timeout=300)
        self.assertEqual(self.booted.run("find", "/etc", "/usr", "/var/cache", "-name",
                                         "*heliograph*"), "")
        self.assertEqual(self.properties("ActiveState", "LoadState"),
                         {"ActiveState": "inactive", "LoadState": "not-found"})
        # Restore the service for the following tests.
        self.booted.run("dpkg", "--install", "/root/heliograph.deb", timeout=300)
        self.configure(self.booted.system)


class OfThisBuild(ServiceTest, unittest.IsolatedAsyncioTestCase):
    @classmethod
    def choose(cls):
        cls.suite = release_of_this_machine()
        cls.package = packages.of_this_build(cls.work)


class OfTheImage(ServiceTest, unittest.IsolatedAsyncioTestCase):
    @classmethod
    def choose(cls):
        cls.suite = "trixie"
        cls.package = packages.of_the_image()


if __name__ == "__main__":
    unittest.main()
