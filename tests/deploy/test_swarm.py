"""Three engines on three machines as one swarm: what happens when one is unplugged."""

import asyncio
import os
import time
import unittest

import yaml

from harness import images
from harness.files import DEPLOY
from harness.fleet import add_images
from harness.replaying_viewer import ReplayingViewer, Wish
from harness.scenes import NAMES, make_scenes, service_override
from harness.servers import TOKEN
from harness.site import Site


class Swarm(unittest.IsolatedAsyncioTestCase):
    @classmethod
    def setUpClass(cls):
        cls.site = cls.enterClassContext(Site())
        cls.manager, *cls.workers = [cls.site.add_machine() for _ in range(3)]
        add_images(cls.manager)
        for worker in cls.workers:
            images.copy_images(cls.manager, worker, images.SERVER, images.BALANCER)
        cls.manager.docker("swarm", "init", "--advertise-addr", cls.manager.address)
        token = cls.manager.docker("swarm", "join-token", "--quiet", "worker")
        for worker in cls.workers:
            worker.docker("swarm", "join", "--token", token, f"{cls.manager.address}:2377")
        override = os.path.join(cls.manager.folder, "override.yaml")
        with open(override, "w", encoding="utf-8") as file:
            yaml.safe_dump({"version": "3.8", "services": {"heliograph": service_override(
                make_scenes(cls.site.folder))}}, file)
        started = time.monotonic()
        cls.manager.docker("stack", "deploy", "--resolve-image", "never", "--compose-file",
                           f"{DEPLOY}/stack.yaml", "--compose-file", override, "heliograph",
                           environment={"HELIOGRAPH_TOKEN": TOKEN})
        cls.wait_for_replicas({"heliograph_heliograph": "3/3", "heliograph_balancer": "3/3"})
        print(f"swarm: all services up after {time.monotonic() - started:.1f} s", flush=True)

    @classmethod
    def replicas(cls):
        lines = cls.manager.docker("service", "ls", "--format", "{{.Name}} {{.Replicas}}")
        return {line.split()[0]: line.split()[1] for line in lines.splitlines()}

    @classmethod
    def wait_for_replicas(cls, wanted, timeout=600):
        deadline = time.monotonic() + timeout
        while {name: cls.replicas().get(name) for name in wanted} != wanted:
            if time.monotonic() > deadline:
                raise AssertionError(f"{cls.replicas()}\n" + cls.manager.docker(
                    "service", "ps", "--no-trunc", *wanted))
            time.sleep(0.5)

    def machines_of(self, service):
        """Where its tasks run, told by the manager."""
        lines = self.manager.docker("service", "ps", "--filter", "desired-state=running",
                                    "--format", "{{.Node}} {{.CurrentState}}", service)
        return sorted(line.split()[0] for line in lines.splitlines() if "Running" in line)

    def url(self, machine):
        return f"http://{machine.address}:8080/"

    async def viewers(self):
        """Through the manager's balancer; enough of them that one is on every node."""
        found = []
        for i in range(3):
            wish = Wish(NAMES[i % 2], eye=(i, 2.0, 8.0))
            viewer = ReplayingViewer(self.url(self.manager), TOKEN, wish)
            await viewer.__aenter__()
            self.addAsyncCleanup(viewer.__aexit__)
            found.append(viewer)
        return found

    async def test_a_machine_is_unplugged_and_the_service_goes_on(self):
        self.assertEqual(self.machines_of("heliograph_heliograph"), ["hg1", "hg2", "hg3"])
        viewers = await self.viewers()
        self.assertEqual(len({viewer.node for viewer in viewers}), 3)
        lost = self.workers[-1]
        unplugged = time.monotonic()
        lost.unplug()
        try:
            deadline = unplugged + 30
            while not any(viewer.losses for viewer in viewers):
                self.assertLess(time.monotonic(), deadline, "nobody was cut off")
                await asyncio.sleep(0.05)
            for viewer in viewers:
                await viewer.whole(timeout=30)
            away = [viewer.losses[0].back_at - unplugged for viewer in viewers if viewer.losses]
            self.assertEqual(len(away), 1)
            print(f"swarm: unplugged machine, viewer whole again after {away[0]:.1f} s", flush=True)
            self.assertLess(away[0], 15)

            async with ReplayingViewer(self.url(self.manager), TOKEN, Wish(NAMES[0])):
                print("swarm: a new viewer is served "
                      f"{time.monotonic() - unplugged:.1f} s after the unplugging", flush=True)
            deadline = unplugged + 180
            while self.machines_of("heliograph_heliograph").count("hg3") or \
                    len(self.machines_of("heliograph_heliograph")) != 3:
                self.assertLess(time.monotonic(), deadline, "no replacement came")
                await asyncio.sleep(0.5)
            print(f"swarm: replaced after {time.monotonic() - unplugged:.1f} s", flush=True)
        finally:
            lost.plug()


if __name__ == "__main__":
    unittest.main()
