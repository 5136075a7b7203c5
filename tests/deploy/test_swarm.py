"""Three engines on three machines as one swarm: what happens when one is unplugged."""

import asyncio
import os
import time
import unittest

import yaml

from harness import images
from harness.files import DEPLOY, text_of
from harness.fleet import add_images
from harness.replaying_viewer import ReplayingViewer, ViewState
from harness.scenes import NAMES, make_scenes, service_override
from harness.servers import TOKEN, get
from harness.site import GATEWAY, Site


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
            yaml.safe_dump({"version": "3.9", "services": {"heliograph": service_override(
                make_scenes(cls.site.folder))}}, file)
        tokens = os.path.join(cls.manager.folder, "tokens")
        with open(tokens, "w", encoding="ascii") as file:
            file.write(f"control {TOKEN}\n")
        cls.manager.docker("secret", "create", "heliograph-tokens", tokens)
        started = time.monotonic()
        cls.manager.docker("stack", "deploy", "--resolve-image", "never", "--compose-file",
                           f"{DEPLOY}/stack.yaml", "--compose-file", override, "heliograph")
        cls.wait_for_replicas({"heliograph_heliograph": "3/3", "heliograph_balancer": "3/3"})
        print(f"swarm: all services up after {time.monotonic() - started:.1f} s", flush=True)

    @classmethod
    def replicas(cls):
        lines = cls.manager.docker("service", "ls", "--format", "{{.Name}} {{.Replicas}}")
        return {line.split()[0]: line.split()[1] for line in lines.splitlines()}

    @classmethod
    def wait_for_replicas(cls, expected, timeout=600):
        deadline = time.monotonic() + timeout
        while {name: cls.replicas().get(name) for name in expected} != expected:
            if time.monotonic() > deadline:
                raise AssertionError(f"{cls.replicas()}\n" + cls.manager.docker(
                    "service", "ps", "--no-trunc", *expected))
            time.sleep(0.5)

    def machines_of(self, service):
        """The machines of its tasks, according to the manager."""
        lines = self.manager.docker("service", "ps", "--filter", "desired-state=running",
                                    "--format", "{{.Node}} {{.CurrentState}}", service)
        return sorted(line.split()[0] for line in lines.splitlines() if "Running" in line)

    def url(self, machine):
        return f"http://{machine.address}:8080/"

    def test_every_balancer_routes_a_session_to_the_same_node(self):
        """Including a balancer that started later and therefore lists the nodes in another order."""
        lost = self.workers[0]
        for service in ("heliograph", "balancer"):
            name, = lost.docker("ps", "--filter", f"name=heliograph_{service}.", "--format",
                                "{{.Names}}").split()
            lost.docker("kill", name)
        machines = (self.manager, *self.workers)
        self.wait_for_the_same_nodes(machines)
        nodes = set()
        for number in range(12):
            served = {self.served_by(machine, path) for machine in machines for path in
                      (f"?session=s{number}", f"api/v1/sessions/s{number}/frame.jpg")}
            self.assertEqual(len(served), 1, f"s{number}")
            nodes |= served
        self.assertGreater(len(nodes), 1, "nothing is balanced")

    def wait_for_the_same_nodes(self, machines):
        """Waits until every balancer routes to all three nodes and to no other."""
        known, deadline = {}, time.monotonic() + 120
        while len(known) != len(machines) or len(set(known.values())) != 1 or any(
                None in nodes or len(nodes) != 3 for nodes in known.values()):
            self.assertLess(time.monotonic(), deadline, f"{known}")
            for machine in machines:
                known[machine.name] = frozenset(
                    self.served_by(machine, "api/v1/schema") for _ in range(9))
            time.sleep(0.2)

    def served_by(self, machine, path):
        """The node's address, or None if none can be reached."""
        try:
            return get(self.url(machine) + path)[1].get("X-Heliograph-Node")
        except OSError:
            return None

    async def test_nodes_see_the_addresses_of_viewers(self):
        await self.viewers()
        name, = self.manager.docker("ps", "--filter", "name=heliograph_heliograph.", "--format",
                                    "{{.Names}}").split()
        log = text_of(self.manager.inspect(name, "{{json .LogPath}}"))
        self.assertIn(f'"client":"{GATEWAY}"', log.replace("\\", "").replace(": ", ":"))

    def test_limits_are_those_of_compose(self):
        for service, pids in (("heliograph", 256), ("balancer", 64)):
            name, = self.manager.docker("ps", "--filter", f"name=heliograph_{service}.", "--format",
                                        "{{.Names}}").split()
            host = self.manager.inspect(name, "{{json .HostConfig}}")
            self.assertEqual(host["PidsLimit"], pids)
            self.assertEqual(host["CapDrop"], ["ALL"])
            self.assertTrue(host["ReadonlyRootfs"])
            if service == "heliograph":
                mounts = self.manager.docker("exec", name, "cat", "/proc/mounts").splitlines()
                options, = [line.split()[3].split(",") for line in mounts
                            if line.split()[1] == "/tmp"]
                self.assertLessEqual({"size=65536k", "noexec", "nosuid", "nodev"}, set(options))
                environment = self.manager.inspect(name)["Config"]["Env"]
                self.assertFalse([entry for entry in environment if TOKEN in entry])

    async def viewers(self):
        """Through the manager's balancer; enough that every node has one."""
        found = []
        for i in range(3):
            view = ViewState(NAMES[i % 2], eye=(i, 2.0, 8.0))
            viewer = ReplayingViewer(self.url(self.manager), TOKEN, view)
            await viewer.__aenter__()
            self.addAsyncCleanup(viewer.__aexit__)
            found.append(viewer)
        return found

    async def test_the_service_survives_an_unplugged_machine(self):
        self.assertEqual(self.machines_of("heliograph_heliograph"), ["hg1", "hg2", "hg3"])
        viewers = await self.viewers()
        self.assertEqual(len({viewer.node for viewer in viewers}), 3)
        lost = self.workers[-1]
        unplugged = time.monotonic()
        lost.unplug()
        try:
            deadline = unplugged + 30
            while not any(viewer.losses for viewer in viewers):
                self.assertLess(time.monotonic(), deadline, "no viewer was disconnected")
                await asyncio.sleep(0.05)
            for viewer in viewers:
                await viewer.whole(timeout=30)
            away = [viewer.losses[0].back_at - unplugged for viewer in viewers if viewer.losses]
            self.assertEqual(len(away), 1)
            print(f"swarm: unplugged machine, viewer restored after {away[0]:.1f} s", flush=True)
            self.assertLess(away[0], 15)

            async with ReplayingViewer(self.url(self.manager), TOKEN, ViewState(NAMES[0])):
                print("swarm: a new viewer is served "
                      f"{time.monotonic() - unplugged:.1f} s after the unplugging", flush=True)
            deadline = unplugged + 180
            while self.machines_of("heliograph_heliograph").count("hg3") or \
                    len(self.machines_of("heliograph_heliograph")) != 3:
                self.assertLess(time.monotonic(), deadline, "no replacement started")
                await asyncio.sleep(0.5)
            print(f"swarm: replaced after {time.monotonic() - unplugged:.1f} s", flush=True)
        finally:
            lost.plug()


if __name__ == "__main__":
    unittest.main()
