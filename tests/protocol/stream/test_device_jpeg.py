"""Frames that the device encodes: here a processor, which is told to."""

import asyncio
import contextlib
import os
import subprocess

from harness.exposition import parse
from harness.images import decode_jpeg, difference
from harness.server import TIME_FACTOR, ServerTestCase
from harness.viewer import Viewer


def encoded(server, kind):
    page = server.get("/metrics")[2].decode()
    return parse(page)["heliograph_frames_encoded_total"].samples["", (("kind", kind),)]


class DeviceJpeg(ServerTestCase):
    arguments = ("--gpu-jpeg", "on")

    async def test_frames_of_a_moving_view_are_encoded_by_the_device(self):
        async with Viewer(self.server) as viewer:
            await viewer.call("stream.configure", {"width": 319, "height": 181, "quality": 75})
            await viewer.call("stats.subscribe", {"interval_ms": 50})
            await viewer.rest()
            before = encoded(self.server, "device"), encoded(self.server, "host")
            async with viewer.moving():
                await viewer.next_frame()
                viewer.notifications.clear()
                for _ in range(5):
                    frame = await viewer.frame_where(
                        lambda frame: frame.header["quality"] == 75)
                    image = decode_jpeg(frame.payload)
                    self.assertEqual((image.width, image.height), (319, 181))
                    self.assertFalse(image.full_chroma)
                    self.assertIn(b"\xff\xdd\x00\x04", frame.payload, "no restart intervals")
                stats = await viewer.notification("stats.frame")
            self.assertEqual(stats["encoder"], "device")
            names = [one["name"] for one in stats["passes"]]
            self.assertEqual(names[-3:], ["jpeg.code", "jpeg.place", "jpeg.join"])
            self.assertGreaterEqual(encoded(self.server, "device"), before[0] + 5)
            final = await viewer.rest()
            self.assertGreaterEqual(final.header["quality"], 95)
            self.assertTrue(decode_jpeg(final.payload).full_chroma)
            self.assertGreater(encoded(self.server, "host"), before[1])

    async def test_the_last_moving_frame_shows_what_the_final_frame_shows(self):
        async with Viewer(self.server) as viewer:
            await viewer.call("stream.configure", {"width": 161, "height": 97, "quality": 95})
            await viewer.call("camera.set", {"eye": [3, 1, 3], "seq": 41})
            moving = None
            while True:
                frame = await viewer.next_frame()
                if frame.header["input_seq_echo"] != 41:
                    continue
                if frame.final:
                    break
                moving = frame
            apart = difference(decode_jpeg(moving.payload), decode_jpeg(frame.payload))
            self.assertLess(apart, 6)

    async def test_viewers_of_two_qualities_are_encoded_for_by_the_host(self):
        async with Viewer(self.server) as one, Viewer(self.server) as other:
            await one.call("stream.configure", {"quality": 75})
            await other.call("stream.configure", {"quality": 40})
            await one.rest()
            await other.rest()
            before = encoded(self.server, "device")
            await one.call("camera.set", {"eye": [3, 2, 3]})
            for viewer, quality in ((one, 75), (other, 40)):
                frame = await viewer.frame_where(
                    lambda frame, quality=quality: frame.header["quality"] == quality)
                decode_jpeg(frame.payload)
            await one.rest()
            self.assertEqual(encoded(self.server, "device"), before)


class SlowLink(ServerTestCase):
    """On a server of its own: how many bytes a frame has depends on what the camera sees."""

    arguments = ("--gpu-jpeg", "on")

    async def encoded_while_moving(self):
        """By kind. A request that held up the movement would make the view a static one."""
        return {kind: await asyncio.to_thread(encoded, self.server, kind)
                for kind in ("device", "host")}

    @contextlib.asynccontextmanager
    async def slow_link(self, viewer, rate):
        """Acknowledges each frame when so many bytes a second would have brought it."""
        frames = []

        async def acknowledge():
            while True:
                frame = await viewer.frames.get()
                frames.append(frame)
                await asyncio.sleep(len(frame.payload) / rate)
                await viewer.notify("stream.ack", {"frame_seq": frame.header["frame_seq"]})
        task = asyncio.create_task(acknowledge())
        try:
            yield frames
        finally:
            task.cancel()
            with contextlib.suppress(asyncio.CancelledError):
                await task

    async def test_what_a_slow_link_is_sent_is_made_smaller_by_the_device(self):
        def smaller(frame):
            return frame.header["width"] < frame.header["full_width"]

        async with Viewer(self.server, acknowledge=False) as viewer:
            await viewer.call("stream.configure", {"width": 319, "height": 181, "quality": 80})
            async with self.slow_link(viewer, 30_000) as frames, viewer.moving():
                async with asyncio.timeout(60 * TIME_FACTOR):
                    while not frames or not smaller(frames[-1]):
                        await asyncio.sleep(0.1)
                    before = await self.encoded_while_moving()
                    received = len(frames)
                    while len(frames) < received + 15:
                        await asyncio.sleep(0.1)
                after = await self.encoded_while_moving()
                self.assertGreaterEqual(after["device"], before["device"] + 10)
                self.assertEqual(after["host"], before["host"])
            frame = [frame for frame in frames if smaller(frame)][-1]
            header, image = frame.header, decode_jpeg(frame.payload)
            print(f"{image.width} x {image.height}, quality {header['quality']} ", end="")
            self.assertIn((image.width, image.height), ((239, 136), (160, 91)))
            self.assertEqual((header["width"], header["height"]), (image.width, image.height))
            self.assertEqual((header["full_width"], header["full_height"]), (319, 181))
            self.assertIn(b"\xff\xdd\x00\x04", frame.payload, "no restart intervals")


class Default(ServerTestCase):
    arguments = ("--device", "llvmpipe")

    def test_a_server_leaves_it_to_gpus(self):
        text = subprocess.run([os.environ["HELIOGRAPH_BINARY"], "serve", "--help"], check=True,
                              capture_output=True, text=True).stdout
        line = next(line for line in text.splitlines() if "--gpu-jpeg" in line)
        self.assertIn("=automatic ", line)

    async def test_a_processor_encodes_without_passes_of_the_device(self):
        async with Viewer(self.server) as viewer:
            await viewer.call("stats.subscribe", {"interval_ms": 50})
            async with viewer.moving():
                stats = await viewer.notification("stats.frame")
            self.assertEqual(stats["encoder"], "host")
            self.assertNotIn("jpeg.code", [one["name"] for one in stats["passes"]])
