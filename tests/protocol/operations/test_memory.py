"""How much memory the server takes."""

import re

from harness.memory import compares_memory
from harness.server import ServerTestCase
from harness.viewer import Viewer

WIDTH, HEIGHT = 1280, 720


def resident(server):
    page = server.get("/metrics")[2].decode()
    return float(re.search(r"^heliograph_resident_memory_bytes (\S+)$", page, re.MULTILINE)[1])


async def drag(viewer, frames):
    for seq in range(1, frames + 1):
        await viewer.notify("camera.orbit", {"yaw": 3, "pitch": 0, "seq": seq})
        await viewer.next_frame(timeout=60)


@compares_memory
class Memory(ServerTestCase):
    async def test_pixel_of_a_session_takes_little_more_than_a_third_of_a_kibibyte(self):
        async with Viewer(self.server) as viewer:
            await viewer.call("stream.configure", {"width": 64, "height": 64})
            await drag(viewer, 5)
            before = resident(self.server)
            await viewer.call("settings.patch", {"patch": {"motion": {"scale": 1}}})
            await viewer.call("stream.configure", {"width": WIDTH, "height": HEIGHT})
            await drag(viewer, 5)
            pixel = (resident(self.server) - before) / (WIDTH * HEIGHT)
        print(f"{pixel:.0f} bytes a pixel", flush=True)
        self.assertGreater(pixel, 100)
        self.assertLess(pixel, 375)
