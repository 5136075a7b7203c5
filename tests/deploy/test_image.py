"""The server's image, built from a clean checkout: contents, hardening, limits."""

import asyncio
import contextlib
import os
import re
import socket
import subprocess
import tarfile
import time
import unittest

from harness import images
from harness.checkout import clone
from harness.files import DEPLOY, documents
from harness.image_comparison import (SAME_IMAGE, decode_png, largest_difference_of_means, read,
                              render)
from harness.replaying_viewer import ReplayingViewer, ViewState
from harness.scenes import generate
from harness.servers import HARDENED, TOKEN, Container, get, make_certificate, measurement
from harness.site import GATEWAY, Site

MOST_BYTES = 280e6
SOFTWARE_DEVICE = "llvmpipe"
LARGE = ("glossy_sponza_1", "glossy_sponza_2")
# Three seconds on two processors.
MOST_SECONDS_TO_START = 6.0


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

    def files(self):
        """Every file of the image, with the content of small ones."""
        archive = os.path.join(self.site.folder, "files.tar")
        self.machine.docker("create", "--name", "files", images.SERVER)
        try:
            self.machine.docker("export", "--output", archive, "files")
        finally:
            self.machine.docker("rm", "files")
        self.addCleanup(os.remove, archive)
        with tarfile.open(archive) as tar:
            for member in tar:
                small = member.isfile() and member.size < 2 ** 20
                yield member, tar.extractfile(member).read() if small else b""

    def test_is_small_and_labelled(self):
        image = self.machine.inspect(images.SERVER)
        print(f"image: {image['Size'] / 1e6:.0f} MB unpacked", flush=True)
        self.assertLess(image["Size"], MOST_BYTES)
        config = image["Config"]
        self.assertEqual(config["User"], "10001:10001")
        self.assertEqual(config["Healthcheck"]["Test"], ["CMD", "heliograph", "health"])
        labels = config["Labels"]
        for name in ("title", "description", "licenses", "version", "revision"):
            self.assertTrue(labels[f"org.opencontainers.image.{name}"], name)

    async def test_one_compose_command_builds_and_starts_it(self):
        """From a clean checkout, as the first lines of the file describe for Compose 1.29; without
        Grafana, whose image comes from a registry. Images built before are reused."""
        checkout = os.path.join(self.site.folder, "composed")
        clone(checkout)
        origin = {"revision": "abcdef", "created": "2001-02-03T04:05:06Z",
                  "source": "https://example.org/heliograph"}
        environment = {
            "DOCKER_BUILDKIT": "1", "PATH": "/usr/bin:" + os.environ["PATH"],
            "HELIOGRAPH_TOKEN": TOKEN, "HELIOGRAPH_IMAGE": "heliograph:composed",
            "HELIOGRAPH_ADDRESS": "0.0.0.0:8080",
            **{f"HELIOGRAPH_{name.upper()}": value for name, value in origin.items()}}

        async def compose(*command):
            await asyncio.to_thread(
                self.machine.compose, "--file", os.path.join(checkout, "deploy/compose.yaml"),
                "--project-name", "composed", *command, timeout=1800, environment=environment)

        self.addAsyncCleanup(compose, "down", "--volumes", "--timeout", "5")
        started = time.monotonic()
        await compose("up", "--build", "--detach", "--scale", "heliograph=2", "heliograph",
                      "balancer", "prometheus")
        print(f"image: built and started by Compose in {time.monotonic() - started:.1f} s",
              flush=True)
        composed = self.machine.inspect("heliograph:composed")
        self.assertEqual({name: composed["Config"]["Labels"][f"org.opencontainers.image.{name}"]
                          for name in origin}, origin)
        self.assertEqual(composed["RootFS"], self.machine.inspect(images.SERVER)["RootFS"])
        url = f"http://{self.machine.address}:8080/"
        async with ReplayingViewer(url, TOKEN, ViewState("glossy_sponza_1")) as viewer:
            await viewer.look((1.0, 2.0, 8.0))
            await viewer.wait_frames(1)
            self.assertEqual(viewer.losses, [])

    def test_contains_no_secrets_and_no_build_tools(self):
        history = self.machine.docker("history", "--no-trunc", "--format", "{{.CreatedBy}}",
                                      images.SERVER)
        self.assertNotRegex(history, r"(?i)(token|password|secret)=[^ .]")
        environment = self.machine.inspect(images.SERVER)["Config"]["Env"]
        self.assertFalse([entry for entry in environment
                          if re.match(r"(?i)\w*(token|password|secret|key)\w*=", entry)])
        for member, content in self.files():
            with self.subTest(member.name):
                self.assertNotRegex("/" + member.name, r"/(\.git|node_modules|\.npmrc|id_rsa.*|src)$|"
                                    r"\.(key|o|hpp|cpp)$|/bin/.*(gcc|apt|dpkg|perl)")
                self.assertNotRegex(content, rb"BEGIN [A-Z ]*PRIVATE KEY")

    def test_has_no_set_user_programs(self):
        for member, _ in self.files():
            with self.subTest(member.name):
                self.assertFalse(member.isfile() and member.mode & 0o6000, "set-user or set-group")
                sticky = member.isdir() and member.mode & 0o1000
                writable = not member.issym() and member.mode & 0o002 and member.type in (
                    tarfile.REGTYPE, tarfile.DIRTYPE)
                self.assertFalse(writable and not sticky, "every user may write it")
                self.assertFalse(set(member.pax_headers) & {"SCHILY.xattr.security.capability"})

    def test_can_write_to_declared_folders_only(self):
        """With the options of the documented command."""
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

    async def test_hardened_and_isolated_it_renders_what_the_host_renders(self):
        """No capabilities, no new privileges, a read-only root, and no connections except incoming
        ones on its port."""
        container = self.container("alone", serve=("--scene", "glossy_sponza_1", "--width", "160",
                                                   "--height", "90"))
        self.assertTrue(self.reaches_out("alone"), "not connected before the isolation")
        self.machine.inside("iptables", "-I", "DOCKER-USER", "-i", "docker0", "-m", "conntrack",
                            "--ctstate", "NEW", "-j", "DROP")
        self.addCleanup(self.machine.inside, "iptables", "-F", "DOCKER-USER")
        self.assertFalse(self.reaches_out("alone"))
        await asyncio.to_thread(container.wait_healthy)
        path = "api/v1/sessions/main/frame.png?samples=64"
        status, _, image = await asyncio.to_thread(container.get, path)
        self.assertEqual(status, 200, image)
        scene = os.path.join(self.site.folder, "glossy_sponza_1.glb")
        for name in ("glossy_sponza_1.glb", "glossy_sponza_1.hdr"):
            self.machine.docker("cp", f"alone:/usr/share/heliograph/scenes/{name}",
                                os.path.join(self.site.folder, name))
        host = os.path.join(self.site.folder, "host.png")
        await asyncio.to_thread(render, scene, host, samples=64)
        difference = largest_difference_of_means(decode_png(image), read(host))
        print(f"container: at most {difference:.2f} of 255 from the host's image", flush=True)
        self.assertLess(difference, SAME_IMAGE)

        async with ReplayingViewer(container.url, TOKEN, ViewState("glossy_sponza_1")) as viewer:
            self.assertIn(SOFTWARE_DEVICE, (await viewer.call("hello"))["device"]["name"])
            before = viewer.frames
            for step in range(10):
                await viewer.look((0.1 * step, 2.0, 8.0))
                await asyncio.sleep(0.1)
            await asyncio.sleep(1)
            self.assertGreater(viewer.frames, before + 5)
            self.assertEqual(viewer.losses, [])

    def test_its_first_frame_is_fast(self):
        """Of the demo scene, with the shaders compiled in the image."""
        container = self.container("starting", serve=("--width", "640", "--height", "360"))
        spent = container.wait_ready()
        print(f"container: first frame after {time.monotonic() - container.started_at:.1f} s, "
              f"{spent:.1f} s of processor time", flush=True)
        self.assertLess(spent, MOST_SECONDS_TO_START)
        print(f"container: healthy after {container.wait_healthy():.1f} s", flush=True)

    def test_contains_the_libraries_that_a_gpu_driver_links(self):
        """NVIDIA's driver, which is mounted at run time, also supports glibc before 2.34."""
        names = {os.path.basename(member.name) for member, _ in self.files()}
        self.assertLessEqual({"libc.so.6", "libdl.so.2", "libm.so.6", "libpthread.so.0",
                              "librt.so.1"}, names)

    def test_a_missing_gpu_is_an_error(self):
        """The manifests' environment for a GPU on a machine without one: the driver file exists,
        library does not, and the software device must not be used instead."""
        driver = "/usr/share/heliograph/nvidia_icd.json"

        def said(*command):
            return self.machine.docker("run", "--rm", *HARDENED, "--env", f"VK_DRIVER_FILES={driver}",
                                       "--env", f"HELIOGRAPH_TOKEN={TOKEN}", images.SERVER, *command)

        self.assertRegex(said("devices"), rf"{driver}\n\s*does not load")
        with self.assertRaisesRegex(RuntimeError, "no compatible driver"):
            said("serve")

    def test_health_check_uses_tls(self):
        certificate = os.path.join(self.site.folder, "server.pem")
        make_certificate(certificate, self.machine.address)
        container = self.container(
            "secure", "--volume", f"{certificate}:/run/server.pem:ro",
            "--env", "HELIOGRAPH_TLS_CERTIFICATE=/run/server.pem",
            "--env", "HELIOGRAPH_TLS_KEY=/run/server.pem")
        container.wait_healthy()
        self.assertEqual(container.get("health/ready")[0], 308)
        secure = f"https://{self.machine.address}:8080/health/ready"
        self.assertEqual(get(secure, certificate=certificate)[0], 200)

    def reaches_out(self, container):
        """Whether a connection from inside the container arrives on the host."""
        with socket.create_server((GATEWAY, 0)) as server:
            port = server.getsockname()[1]
            self.machine.docker("exec", container, "timeout", "3", "nc", "-w", "2", GATEWAY,
                                str(port), stdin=subprocess.DEVNULL, check=False)
            server.settimeout(0.1)
            try:
                server.accept()[0].close()
                return True
            except TimeoutError:
                return False

    def test_thread_pools_match_the_cpu_quota(self):
        """Threads of both pools: the software device's, and TBB's, of which one is the calling
        thread."""
        if os.cpu_count() < 2:
            self.skipTest("there is only one processor to be had")
        wide = self.container("wide", port=8081)
        narrow = self.container("narrow", "--cpus", "0.5")
        for container in (wide, narrow):
            container.wait_healthy()
        self.assertEqual(wide.threads().count("llvmpipe"), os.cpu_count())
        self.assertEqual(narrow.threads().count("llvmpipe"), 1)
        self.assertLessEqual(len(narrow.threads()),
                             len(wide.threads()) - 2 * (os.cpu_count() - 1))

    async def test_enforces_and_reports_its_limits(self):
        memory, cpus = 1280 * 2 ** 20, 0.5
        container = self.container("limited", "--memory", str(memory), "--memory-swap", str(memory),
                                   "--cpus", str(cpus))
        await asyncio.to_thread(container.wait_healthy)
        view = ViewState("glossy_sponza_1", size=(320, 180))
        async with ReplayingViewer(container.url, TOKEN, view) as viewer:
            spent, started = container.processor_seconds(), time.monotonic()
            while time.monotonic() - started < 6:
                await viewer.look((time.monotonic() - started, 2.0, 8.0))
                await asyncio.sleep(0.05)
            share = (container.processor_seconds() - spent) / (time.monotonic() - started)
        print(f"container: {share:.2f} of {cpus} processors while moving", flush=True)
        self.assertLess(share, cpus * 1.15)
        self.assertFalse(container.state()["OOMKilled"])
        resident = measurement(container.url, "heliograph_resident_memory_bytes")
        print(f"container: {resident / 2 ** 20:.0f} MiB resident", flush=True)
        self.assertLess(resident, memory)
        self.assertEqual(measurement(container.url, "heliograph_memory_limit_bytes"), memory)
        self.assertEqual(measurement(container.url, "heliograph_cpu_limit_cores"), cpus)

    async def test_the_manifests_request_enough_memory(self):
        """The request covers two sessions with moving cameras in the demo scene, beside main. The
        limit covers the allowed number of pixels, and loading another scene of this size while
        they are shown."""
        folder = os.path.join(self.site.folder, "large")
        await asyncio.to_thread(generate, folder, "--only", LARGE[1])
        beside = [word for name in os.listdir(folder) for word in (
            "--volume", f"{folder}/{name}:/usr/share/heliograph/scenes/{name}:ro")]
        container = self.container("atrium", *beside, serve=(
            "--scene", LARGE[0], "--width", "640", "--height", "360"))
        await asyncio.to_thread(container.wait_ready)
        async with self.looking_around(container) as viewer:
            one = await self.most_memory(container, asyncio.sleep(8))
            async with self.looking_around(container):
                two = await self.most_memory(container, asyncio.sleep(8))
                most = await self.most_memory(container, viewer.call(
                    "scene.load", {"name": LARGE[1]}, timeout=300))
        pixel = (two - one) / (640 * 360)
        print(f"container: {two / 2 ** 20:.0f} MiB with three sessions in the demo scene, at most "
              f"{most / 2 ** 20:.0f} while another loads, {pixel:.0f} bytes per pixel", flush=True)
        pod = documents(os.path.join(DEPLOY, "kubernetes/deployment.yaml"))[0]["spec"]["template"]
        server = pod["spec"]["containers"][0]
        asked, limit = (mebibytes(server["resources"][kind]["memory"]) * 2 ** 20
                        for kind in ("requests", "limits"))
        pixels, = [int(entry["value"]) for entry in server["env"]
                   if entry["name"] == "HELIOGRAPH_MAX_PIXELS"]
        self.assertLess(two, asked)
        self.assertLess(most + (pixels - 3 * 640 * 360) * pixel, limit)

    @contextlib.asynccontextmanager
    async def looking_around(self, container):
        """A viewer in its own session, with a moved camera."""
        view = ViewState(LARGE[0], size=(640, 360))
        async with ReplayingViewer(container.url, TOKEN, view) as viewer:
            for step in range(3):
                await viewer.look((0.1 * step, 2.0, 8.0))
                await viewer.wait_frames(1)
            yield viewer

    async def most_memory(self, container, work):
        """While something is being done."""
        most, task = 0, asyncio.create_task(work)
        while not task.done():
            most = max(most, await asyncio.to_thread(container.memory_bytes))
            await asyncio.sleep(0.05)
        task.result()
        return max(most, container.memory_bytes())

    def test_exceeding_memory_kills_the_container_only(self):
        memory = 48 * 2 ** 20
        container = self.container("starved", "--memory", str(memory), "--memory-swap", str(memory))
        deadline = time.monotonic() + 90
        while container.running():
            self.assertLess(time.monotonic(), deadline, "it lives in 48 MiB")
            time.sleep(0.2)
        # Killed by the kernel for this reason; a crash would end the container too. The engine may
        # learn of the exit before it learns of the reason.
        while not container.state()["OOMKilled"]:
            self.assertLess(time.monotonic(), deadline, f"{container.state()}\n{container.log()}")
            time.sleep(0.2)

    async def test_closes_viewers_on_shutdown(self):
        container = self.container("ending", "--env", "HELIOGRAPH_DRAIN_NOTICE=1")
        await asyncio.to_thread(container.wait_healthy)
        async with ReplayingViewer(container.url, TOKEN, ViewState("glossy_sponza_1")) as viewer:
            started = time.monotonic()
            await asyncio.to_thread(self.machine.docker, "stop", "--time", "20", "ending")
            seconds = time.monotonic() - started
            await asyncio.sleep(0.2)
            self.assertEqual(viewer.losses[0].code, 1001)
        print(f"container: ended {seconds:.1f} s after SIGTERM", flush=True)
        self.assertLess(seconds, 10)
        self.assertEqual(container.state()["ExitCode"], 0)

    def test_lists_its_devices(self):
        listed = self.machine.docker("run", "--rm", "--read-only", images.SERVER, "devices")
        self.assertIn(SOFTWARE_DEVICE, listed)


def mebibytes(quantity):
    """In the notation of Kubernetes: 512Mi, 2Gi."""
    return int(quantity[:-2]) * {"Mi": 1, "Gi": 1024}[quantity[-2:]]


if __name__ == "__main__":
    unittest.main()
