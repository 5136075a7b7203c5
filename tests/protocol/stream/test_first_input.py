"""The first input on a view that is refined is answered as soon as later ones are."""

import asyncio
import statistics
import unittest

from harness.server import TIME_FACTOR, Server
from harness.viewer import Viewer

SAMPLES = 4
DRAGGED = 5  # frames
ATTEMPTS = 3


class FirstInput(unittest.IsolatedAsyncioTestCase):
    @classmethod
    def setUpClass(cls):
        cls.server = Server("--scene", "mirror")

    @classmethod
    def tearDownClass(cls):
        cls.server.stop()

    async def move(self, viewer):
        """Turns the camera; gives the frame that shows it, and how long that took beside its own
        time, in seconds."""
        self.seq += 1
        start = asyncio.get_running_loop().time()
        eye = [0.01 * self.seq, 1.5, 4]
        await viewer.notify("camera.set", {"eye": eye, "target": [0, 1, 0], "seq": self.seq})
        frame = await viewer.frame_where(lambda f: f.header["input_seq_echo"] >= self.seq)
        return frame, frame.received_at - start - frame.header["render_us"] / 1e6

    async def waits(self, viewer, samples):
        """What the first input waits before its frame begins, with the time of a moving frame."""
        await viewer.frame_where(lambda f: f.header["sample_count"] >= samples and
                                 f.header["input_seq_echo"] >= self.seq)
        await asyncio.sleep(0.2)
        _, waited = await self.move(viewer)
        moving = [(await self.move(viewer))[0].header["render_us"] / 1e6 for _ in range(DRAGGED)]
        return waited, statistics.median(moving)

    @unittest.skipIf(TIME_FACTOR > 1, "sanitizers slow answers down by more than frames")
    async def test_it_ends_a_sample_of_the_hybrid_and_of_the_path_tracer(self):
        self.seq = 0
        most = {"accumulation": {"max_samples": SAMPLES}, "reference": {"samples": 65536}}
        self.server.call("settings.patch", {"patch": most})
        async with Viewer(self.server) as viewer:
            await viewer.call("stream.configure", {"width": 640, "height": 360})
            for samples in (2, SAMPLES + 2):
                found = [await self.waits(viewer, samples) for _ in range(ATTEMPTS)]
                print(f"from {samples} samples on: " + ", ".join(
                    f"{1000 * waited:.0f} of {1000 * frame:.0f} ms" for waited, frame in found))
                waited, frame = (statistics.median(part) for part in zip(*found))
                self.assertLess(waited, frame)


if __name__ == "__main__":
    unittest.main()
