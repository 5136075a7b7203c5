"""The server's image: built from a clean checkout, hardened, limited, and what is in it."""

import asyncio
import os
import re
import time
import unittest

from harness import images
from harness.commands import succeeds
from harness.pictures import decode_png, largest_difference_of_means, read, render
from harness.replaying_viewer import ReplayingViewer, Wish
from harness.servers import TOKEN, Container, measurement
from harness.site import Site

MOST_BYTES = 280e6
SOFTWARE_DEVICE = "llvmpipe"


class Image(unittest.IsolatedAsyncioTestCase):
    @classmethod
    def setUpClass(cls):
        cls.site = cls.enterClassContext(Site())
        cls.machine = cls.site.add_machine()
        images.add_base(cls.machine)
        started = time.monotonic()
        if os.environ.get("HELIOGRAPH_IMAGE_ARCHIVE"):
            images.add_server(cls.machine)
        else:
            images.build_server(cls.machine)
        print(f"image: built in {time.monotonic() - started:.0f} s", flush=True)

    def container(self, name, *options, **more):
        container = Container(self.machine, name, *options, **more)
        self.addCleanup(container.remove)
        return container

    def inside(self, *command, check=True):
        """A program of the image, as the image's user, in a container of its own."""
        return self.machine.docker("run", "--rm", "--read-only", "--tmpfs", "/tmp", "--network",
                                   "none", "--entrypoint", command[0], images.SERVER, *command[1:],
                                   check=check)

    def test_is_small_and_says_what_it_is(self):
        image = self.machine.inspect(images.SERVER)
        print(f"image: {image['Size'] / 1e6:.0f} MB unpacked", flush=True)
        self.assertLess(image["Size"], MOST_BYTES)
        config = image["Config"]
        self.assertEqual(config["User"], "10001:10001")
        self.assertEqual(config["Healthcheck"]["Test"], ["CMD", "heliograph", "health"])
        labels = config["Labels"]
        for name in ("title", "description", "licenses", "version", "revision"):
            self.assertTrue(labels[f"org.opencontainers.image.{name}"], name)

    def test_holds_no_secret_and_no_tool_of_the_build(self):
        history = self.machine.docker("history", "--no-trunc", "--format", "{{.CreatedBy}}",
                                      images.SERVER)
        self.assertNotRegex(history, r"(?i)(token|password|secret)=[^ .]")
        environment = self.machine.inspect(images.SERVER)["Config"]["Env"]
        self.assertFalse([entry for entry in environment
                          if re.match(r"(?i)\w*(token|password|secret|key)\w*=", entry)])
        found = self.inside("find", "/", "-xdev", "(", "-name", ".git", "-o", "-name",
                            "node_modules", "-o", "-name", ".npmrc", "-o", "-name", "id_rsa*", "-o",
                            "-name", "*.key", "-o", "-path", "/src", "-o", "-path",
                            "/usr/bin/*gcc*", "-o", "-name", "*.o", ")", check=False)
        self.assertEqual(found, "")
        keys = self.inside("grep", "-rlI", "--exclude-dir=proc", "--exclude-dir=sys", "-e",
                           "BEGIN [A-Z ]*PRIVATE KEY", "/etc", "/usr", "/var", "/opt", "/root",
                           "/home", check=False)
        self.assertEqual(keys, "")

    def test_lets_nobody_become_another_user(self):
        self.assertEqual(self.inside("find", "/", "-xdev", "-type", "f", "-perm", "/6000",
                                     check=False), "")
        capable = self.inside("find", "/usr/bin", "/usr/sbin", "-xdev", "-type", "f", "-user",
                              "root", "-perm", "/022", check=False)
        self.assertEqual(capable, "")

    def test_can_write_only_where_it_is_declared(self):
        """Under the options that the documentation tells to run it with."""
        container = self.container("writer")
        container.wait_healthy()
        probe = ("find / -type d \\( -path /proc -o -path /sys \\) -prune -o -type d -print | "
                 "while read -r folder; do "
                 "if (: >\"$folder/.probe\") 2>/dev/null; then rm -f \"$folder/.probe\"; "
                 "echo \"$folder\"; fi; done")
        writable = self.machine.docker("exec", "writer", "sh", "-c", probe).splitlines()
        outside = [path for path in writable if not path.startswith(
            ("/tmp", "/var/cache/heliograph", "/dev/shm", "/dev/mqueue"))]
        self.assertEqual(outside, [])
        self.assertIn("/var/cache/heliograph", writable)

    async def test_hardened_and_without_a_way_out_it_streams_what_the_host_renders(self):
        """No capability, no new privileges, a root that cannot be written, and no connection but
        those that come to its port."""
        container = self.container("alone", serve=("--scene", "pillars", "--width", "160",
                                                   "--height", "90"))
        self.machine.inside("iptables", "-I", "DOCKER-USER", "-i", "docker0", "-m", "conntrack",
                            "--ctstate", "NEW", "-j", "DROP")
        self.addCleanup(self.machine.inside, "iptables", "-F", "DOCKER-USER")
        seconds = await asyncio.to_thread(container.wait_healthy)
        print(f"container: healthy after {seconds:.1f} s", flush=True)
        self.assertLess(seconds, 60)
        out = "exec 3<>/dev/tcp/10.213.7.254/53"
        self.assertFalse(succeeds("timeout", "5", "docker", "--host",
                                  f"unix://{self.machine.socket}", "exec", "alone", "bash", "-c",
                                  out), "a connection out was possible")

        path = "api/v1/sessions/main/frame.png?samples=64"
        status, _, picture = await asyncio.to_thread(container.get, path)
        self.assertEqual(status, 200, picture)
        scene = os.path.join(self.site.folder, "pillars.glb")
        for name in ("pillars.glb", "pillars.hdr"):
            self.machine.docker("cp", f"alone:/usr/share/heliograph/scenes/{name}",
                                os.path.join(self.site.folder, name))
        host = os.path.join(self.site.folder, "host.png")
        await asyncio.to_thread(render, scene, host, samples=64)
        difference = largest_difference_of_means(decode_png(picture), read(host))
        print(f"container: at most {difference:.2f} of 255 from the host's picture", flush=True)
        self.assertLess(difference, 2.5)

        async with ReplayingViewer(container.url, TOKEN, Wish()) as viewer:
            self.assertIn(SOFTWARE_DEVICE, (await viewer.call("hello"))["device"]["name"])
            before = viewer.frames
            for step in range(10):
                await viewer.look((0.1 * step, 2.0, 8.0))
                await asyncio.sleep(0.1)
            await asyncio.sleep(1)
            self.assertGreater(viewer.frames, before + 5)
            self.assertEqual(viewer.losses, [])

    async def test_keeps_to_its_limits_and_tells_them(self):
        memory, cpus = 768 * 2 ** 20, 0.5
        container = self.container("limited", "--memory", str(memory), "--memory-swap", str(memory),
                                   "--cpus", str(cpus), "--env", "LP_NUM_THREADS=1")
        await asyncio.to_thread(container.wait_healthy, 240)
        async with ReplayingViewer(container.url, TOKEN, Wish(size=(320, 180))) as viewer:
            spent, started = self._cpu_seconds("limited"), time.monotonic()
            while time.monotonic() - started < 6:
                await viewer.look((time.monotonic() - started, 2.0, 8.0))
                await asyncio.sleep(0.05)
            share = (self._cpu_seconds("limited") - spent) / (time.monotonic() - started)
        print(f"container: {share:.2f} of {cpus} processors while moving", flush=True)
        self.assertLess(share, cpus * 1.15)
        self.assertFalse(container.state()["OOMKilled"])
        resident = measurement(container.url, "resident_memory_bytes")
        print(f"container: {resident / 2 ** 20:.0f} MiB resident", flush=True)
        self.assertLess(resident, memory)
        self.assertEqual(measurement(container.url, "memory_limit_bytes"), memory)
        self.assertEqual(measurement(container.url, "cpu_limit_cores"), cpus)

    def _cpu_seconds(self, name):
        process = self.machine.inspect(name, "{{.State.Pid}}")
        with open(f"/proc/{process}/stat", encoding="ascii") as file:
            fields = file.read().rsplit(")", 1)[1].split()
        return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")

    def test_too_little_memory_ends_the_container_not_the_machine(self):
        memory = 48 * 2 ** 20
        container = self.container("starved", "--memory", str(memory), "--memory-swap", str(memory))
        deadline = time.monotonic() + 90
        while container.running():
            self.assertLess(time.monotonic(), deadline, "it lives in 48 MiB")
            time.sleep(0.2)
        self.assertTrue(container.state()["OOMKilled"] or container.state()["ExitCode"] != 0)

    async def test_sends_its_viewers_away_when_it_ends(self):
        container = self.container("ending", "--env", "HELIOGRAPH_DRAIN_NOTICE=1")
        await asyncio.to_thread(container.wait_healthy)
        async with ReplayingViewer(container.url, TOKEN, Wish()) as viewer:
            started = time.monotonic()
            await asyncio.to_thread(self.machine.docker, "stop", "--time", "20", "ending")
            seconds = time.monotonic() - started
            await asyncio.sleep(0.2)
            self.assertEqual(viewer.losses[0].code, 1001)
        print(f"container: ended {seconds:.1f} s after SIGTERM", flush=True)
        self.assertLess(seconds, 10)
        self.assertEqual(container.state()["ExitCode"], 0)

    def test_names_its_devices(self):
        listed = self.machine.docker("run", "--rm", "--read-only", images.SERVER, "devices")
        self.assertIn(SOFTWARE_DEVICE, listed)


if __name__ == "__main__":
    unittest.main()
