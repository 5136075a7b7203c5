"""Path traced samples of a static view take their turns behind the moving images of other sessions."""

import asyncio

from harness.exposition import parse
from harness.server import ServerTestCase
from harness.viewer import Viewer

SECONDS = 2


class ReferenceTurns(ServerTestCase):
    def rendered(self):
        """Frames of all sessions so far."""
        family = parse(self.server.get("/metrics")[2].decode())["heliograph_render_seconds"]
        return sum(value for (name, _), value in family.samples.items() if name.endswith("_count"))

    async def during(self, viewer=None):
        """Frames that are rendered in some time, and those of them that are this viewer's."""
        first = (await viewer.next_frame()).header["render_id"] if viewer else 0
        before = self.rendered()
        await asyncio.sleep(SECONDS)
        rendered = self.rendered() - before
        if not viewer:
            return rendered, 0
        while not viewer.frames.empty():
            last = (await viewer.next_frame()).header["render_id"]
        return rendered, last - first

    async def test_they_wait_while_another_image_moves(self):
        self.server.call("settings.patch", {"patch": {"reference": {"samples": 65536}}})
        self.server.call("session.create", {"name": "other", "copy_of": "main"})
        self.addCleanup(self.server.call, "session.close", {"session": "other"})
        async with Viewer(self.server) as static, Viewer(self.server, session="other") as moving:
            await static.frame_where(lambda frame: frame.header["sample_count"] > 8)
            async with moving.moving():
                await moving.next_frame()
                await asyncio.sleep(1)
                rendered, own = await self.during(moving)
                self.assertGreater(own, 5)
                # A frame may begin before the moving one is due, and counts are read at other times.
                self.assertLess(rendered - own, 0.1 * own + 3)
            await moving.call("camera.set", {"eye": [3, 2, 3]})
            await moving.frame_where(lambda frame: frame.header["sample_count"] > 8)
            rendered, _ = await self.during()
            self.assertGreater(rendered, 5, "nothing goes on after the image has come to rest")
