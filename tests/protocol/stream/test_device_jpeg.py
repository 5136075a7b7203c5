"""Frames that the device encodes: here a processor, which is told to."""

from harness.exposition import parse
from harness.images import decode_jpeg, difference
from harness.server import ServerTestCase
from harness.viewer import Viewer


class DeviceJpeg(ServerTestCase):
    arguments = ("--gpu-jpeg", "on")

    def encoded(self, kind):
        page = self.server.get("/metrics")[2].decode()
        return parse(page)["heliograph_frames_encoded_total"].samples["", (("kind", kind),)]

    async def test_frames_of_a_moving_view_are_encoded_by_the_device(self):
        async with Viewer(self.server) as viewer:
            await viewer.call("stream.configure", {"width": 319, "height": 181, "quality": 75})
            await viewer.call("stats.subscribe", {"interval_ms": 50})
            await viewer.rest()
            before = self.encoded("device"), self.encoded("host")
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
            self.assertGreaterEqual(self.encoded("device"), before[0] + 5)
            final = await viewer.rest()
            self.assertGreaterEqual(final.header["quality"], 95)
            self.assertTrue(decode_jpeg(final.payload).full_chroma)
            self.assertGreater(self.encoded("host"), before[1])

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
            before = self.encoded("device")
            await one.call("camera.set", {"eye": [3, 2, 3]})
            for viewer, quality in ((one, 75), (other, 40)):
                frame = await viewer.frame_where(
                    lambda frame, quality=quality: frame.header["quality"] == quality)
                decode_jpeg(frame.payload)
            await one.rest()
            self.assertEqual(self.encoded("device"), before)
