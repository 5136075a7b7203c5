"""A viewer on a slow link with latency and packet loss."""

import asyncio
import math
import statistics
import time
import unittest

from harness import images
from harness.replaying_viewer import ReplayingViewer, ViewState
from harness.scenes import NAMES, make_scenes
from harness.servers import TOKEN, Container
from harness.site import Site
from harness.wide_area import FAR, Line, WideArea

SECONDS = 20


class BadLine(unittest.IsolatedAsyncioTestCase):
    @classmethod
    def setUpClass(cls):
        cls.site = cls.enterClassContext(Site())
        cls.machine = cls.site.add_machine()
        images.add_base(cls.machine)
        images.add_server(cls.machine)
        scenes = make_scenes(cls.site.folder)
        cls.container = Container(cls.machine, "far", "--volume", f"{scenes}:/scenes:ro",
                                  serve=("--scene-root", "/scenes", "--scene", NAMES[0]))
        cls.addClassCleanup(cls.container.remove)
        cls.container.wait_healthy()

    async def watch(self, line):
        """Moves the camera continuously. Returns the seconds from each move to its frame."""
        with WideArea(self.machine, line):
            view = ViewState(NAMES[0], size=(320, 180))
            viewer = ReplayingViewer(f"http://{FAR}:8080/", TOKEN, view)
            async with viewer:
                viewer.round_trips.clear()
                before, started = viewer.frames, time.monotonic()
                while time.monotonic() - started < SECONDS:
                    angle = time.monotonic() - started
                    await viewer.look((8 * math.sin(angle), 2.0, 8 * math.cos(angle)))
                    await asyncio.sleep(0.05)
                frames = viewer.frames - before
                trips = list(viewer.round_trips)
                await asyncio.sleep(5)
                self.assertEqual(viewer.losses, [])
                self.assertFalse(viewer.awaited(), "the last move was never shown")
        return frames, trips

    async def test_latency_stays_bounded_and_frames_keep_coming(self):
        line = Line()
        frames, trips = await self.watch(line)
        half = len(trips) // 2
        early, late = statistics.median(trips[:half]), statistics.median(trips[half:])
        worst = sorted(trips)[int(0.95 * len(trips))]
        print(f"network: 1 Mbit/s, 40 ms each way, 1 % loss: {frames / SECONDS:.1f} frames/s, "
              f"input to frame {early:.2f} s early, {late:.2f} s late, p95 {worst:.2f} s",
              flush=True)
        self.assertGreater(frames, SECONDS)
        self.assertLess(worst, 2.0)
        self.assertLess(late, 1.5 * early + 0.2, "frames are queued")


if __name__ == "__main__":
    unittest.main()
