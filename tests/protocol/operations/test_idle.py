"""An idle server sleeps. Whatever polls keeps a processor from its deep sleep, and whatever is
given to a GPU keeps its clocks up: it costs power around the clock, on every machine."""

import asyncio
import os
import pathlib
import tempfile
import unittest

from harness.exposition import parse
from harness.server import TIME_FACTOR, Server, ServerTestCase
from harness.viewer import Viewer

SHADERS = pathlib.Path(__file__).resolve().parents[3] / "shaders"
# After frames, loads and calls: what they have begun ends.
SETTLING_SECONDS = 3
COUNTED_SECONDS = 4
# Of all threads together. Measured: without viewers none in half a minute, but for the ends of the
# test's own connections. With one 0.4: every five seconds a look at the connection, which sends a
# ping, and the pong. A loop that polls every 300 ms alone makes 3.3.
MOST_WAKEUPS_PER_SECOND = 2
# Measured: 0.0001. A thread that spins takes 1.
MOST_PROCESSORS = 0.02
SESSIONS = 16
# The drivers of GPUs have threads of their own, which poll: NVIDIA's wake 125 times a second.
DEVICE = ("--device", "llvmpipe")


def switches(pid):
    """How often each thread has gone to sleep. Others that need the processor do not count: they
    interrupt it, they do not wake it."""
    counts = {}
    for status in pathlib.Path(f"/proc/{pid}/task").glob("*/status"):
        try:
            fields = dict(line.split(":", 1) for line in status.read_text().splitlines())
        except (FileNotFoundError, ProcessLookupError):
            continue  # it has ended
        counts[f"{fields['Name'].strip()} {status.parent.name}"] = int(
            fields["voluntary_ctxt_switches"])
    return counts


def figures(server):
    """Frames and submissions of all devices."""
    families = parse(server.get("/metrics")[2].decode())
    return {name: sum(families[f"heliograph_device_{name}_total"].samples.values())
            for name in ("frames", "submissions")}


class IdleCase(ServerTestCase):
    async def assert_sleeps(self):
        """Nothing wakes, nothing is drawn and nothing is given to the device."""
        await asyncio.sleep(SETTLING_SECONDS * TIME_FACTOR)
        drawn = figures(self.server)
        await asyncio.sleep(0.5)  # the request's own connection ends
        pid = self.server.process.pid
        before, processors = switches(pid), self.server.cpu_seconds()
        await asyncio.sleep(COUNTED_SECONDS)
        after, processors = switches(pid), self.server.cpu_seconds() - processors
        woken = {thread: count - before.get(thread, 0) for thread, count in after.items()
                 if count > before.get(thread, 0)}
        print(f"{sum(woken.values()) / COUNTED_SECONDS:.2f} wakeups a second", flush=True)
        self.assertLess(sum(woken.values()), MOST_WAKEUPS_PER_SECOND * COUNTED_SECONDS, woken)
        self.assertLess(processors, MOST_PROCESSORS * COUNTED_SECONDS)
        self.assertEqual(figures(self.server), drawn)


@unittest.skipUnless("voluntary_ctxt_switches" in pathlib.Path("/proc/self/status").read_text(),
                     "the system does not count switches")
@unittest.skipIf(TIME_FACTOR > 1, "sanitizers have threads of their own, which poll")
class Idle(IdleCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        folders = [os.path.join(cls.folder.name, name) for name in ("jobs", "uploads")]
        for folder in folders:
            os.mkdir(folder)
        # The software tracer submits every frame also where host kernels draw the rest.
        cls.server = Server(*DEVICE, "--jobs", folders[0], "--uploads", folders[1],
                            "--tracer", "software")

    async def test_a_server_without_viewers_sleeps(self):
        await self.assert_sleeps()

    async def test_a_server_whose_viewer_sees_a_converged_view_sleeps(self):
        async with Viewer(self.server) as viewer:
            await viewer.call("stats.subscribe", {"interval_ms": 100})
            before = figures(self.server)
            await viewer.call("camera.set", {"eye": [3, 3, 3]})
            await viewer.rest()
            for name, count in figures(self.server).items():
                self.assertGreater(count, before[name], f"{name} are counted")
            await self.assert_sleeps()
            self.assertTrue(viewer.frames.empty(), "no frame is sent")

    async def test_sessions_without_viewers_sleep(self):
        for name in (f"idle-{number}" for number in range(SESSIONS)):
            self.server.call("session.create", {"name": name, "copy_of": "main"})
            self.addCleanup(self.server.call, "session.close", {"session": name})
            # It has a renderer from now on.
            self.server.call("frame.capture", {"format": "jpeg", "samples": 1}, session=name)
        await self.assert_sleeps()

    async def test_a_session_that_is_left_while_it_refines_sleeps(self):
        self.server.call("settings.patch", {"patch": {"accumulation": {"max_samples": 4096}}})
        async with Viewer(self.server) as viewer:
            await viewer.next_frame()
        await self.assert_sleeps()


@unittest.skipIf(TIME_FACTOR > 1, "sanitizers have threads of their own, which poll")
class IdleShaderFolder(IdleCase):
    """Files that may be saved at any time are not looked at until the system tells of one."""

    arguments = (*DEVICE, "--shader-dir", str(SHADERS))

    async def test_a_server_that_waits_for_saved_shaders_sleeps(self):
        async with Viewer(self.server) as viewer:
            await viewer.rest()
            await self.assert_sleeps()


if __name__ == "__main__":
    unittest.main()
