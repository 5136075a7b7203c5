"""The frame stream: headers, echoes, final frames, pacing."""

import asyncio
import base64
import contextlib
import socket
import time

from harness.images import decode_jpeg, decode_png, difference
from harness.memory import assert_less_memory, compares_memory
from harness.server import CONVERGED_SAMPLES, FEW_SAMPLES, ServerTestCase
from harness.viewer import FLAG_FIRST_AFTER_DROP, FLAG_KEY, Viewer


class Frames(ServerTestCase):
    async def test_headers_are_valid_and_frames_decode(self):
        async with Viewer(self.server) as viewer:
            await viewer.call("stream.configure", {"width": 160, "height": 90, "quality": 70})
            await viewer.call("camera.set", {"eye": [3, 2, 3]})
            last = None
            for _ in range(3):
                frame = await viewer.next_frame()
                header = frame.header
                self.assertEqual(header["magic"], b"HVRF")
                self.assertEqual((header["version"], header["type"], header["codec"]), (1, 1, 1))
                self.assertEqual(header["header_bytes"], 64)
                self.assertTrue(header["flags"] & FLAG_KEY)
                self.assertEqual((header["full_width"], header["full_height"]),
                                 (header["width"], header["height"]))
                image = decode_jpeg(frame.payload)
                self.assertEqual((image.width, image.height),
                                 (header["width"], header["height"]))
                if last:
                    self.assertGreater(header["frame_seq"], last["frame_seq"])
                    self.assertGreaterEqual(header["render_id"], last["render_id"])
                    self.assertGreaterEqual(header["render_start_us"], last["render_start_us"])
                last = header

    async def test_a_camera_change_shows_and_its_seq_is_echoed(self):
        async with Viewer(self.server) as viewer:
            await viewer.call("camera.set", {"eye": [3, 1, 3], "seq": 41})
            first = await viewer.frame_where(
                lambda frame: frame.final and frame.header["input_seq_echo"] == 41)
            camera = await viewer.call("camera.set", {"eye": [-3, 2, 3], "seq": 42})
            second = await viewer.frame_where(
                lambda frame: frame.final and frame.header["input_seq_echo"] == 42)
            self.assertEqual(second.header["state_rev"], camera["rev"])
            apart = difference(decode_jpeg(first.payload), decode_jpeg(second.payload))
            self.assertGreater(apart, 3)

    async def test_each_viewer_gets_its_own_echo(self):
        async with Viewer(self.server) as mover, Viewer(self.server) as observer:
            camera = await mover.call("camera.set", {"eye": [3, 1, 2], "seq": 9})

            def shows(frame):
                return frame.header["state_rev"] >= camera["rev"]
            self.assertEqual((await mover.frame_where(shows)).header["input_seq_echo"], 9)
            self.assertEqual((await observer.frame_where(shows)).header["input_seq_echo"], 0)

    async def test_a_static_view_ends_with_a_final_frame_and_silence(self):
        async with Viewer(self.server) as viewer:
            await viewer.call("camera.set", {"eye": [3, 2, 2]})
            final = await viewer.rest()
            self.assertEqual(final.header["sample_count"], CONVERGED_SAMPLES)
            self.assertGreaterEqual(final.header["quality"], 95)
            self.assertTrue(decode_jpeg(final.payload).full_chroma)
            received, cpu = viewer.bytes_received, self.server.cpu_seconds()
            await asyncio.sleep(2)
            self.assertEqual(viewer.bytes_received, received, "something came after the final")
            self.assertLess(self.server.cpu_seconds() - cpu, 0.1, "an idle server computes")

    async def test_a_static_view_is_sent_when_its_samples_have_doubled(self):
        self.server.call("settings.patch", {"patch": {"accumulation": {"max_samples": 64}}})
        async with Viewer(self.server) as viewer:
            await viewer.call("camera.set", {"eye": [3, 2, 1]})
            await viewer.rest()
            # The same view is refined again, from its first sample.
            await viewer.call("camera.set", {"eye": [3, 2, 2]})
            samples, final = [], None
            while not final:
                frame = await viewer.next_frame()
                samples.append(frame.header["sample_count"])
                final = frame if frame.final else None
            self.assertEqual(samples[-1], 64 + FEW_SAMPLES["reference"]["samples"])
            # As they come at first, then ever fewer: 64 samples are a few doublings.
            late = [count for count in samples if count >= 16]
            self.assertLess(len(late), 24, samples)
            self.assertLess(len(samples), 64, samples)

    async def test_slow_frames_follow_the_camera(self):
        async with Viewer(self.server) as viewer:
            await viewer.call("settings.patch", {"patch": {"motion": {"scale": 1}}})
            await viewer.call("stream.configure", {"width": 1600, "height": 900})
            async with viewer.moving(rate=20):
                shown = set()
                while len(shown) < 4:  # of a camera that never becomes static
                    shown.add((await viewer.next_frame(timeout=60)).header["state_rev"])

    async def test_a_change_and_its_reversal_produce_a_frame(self):
        async with Viewer(self.server) as viewer:
            await viewer.call("stream.configure", {"width": 960, "height": 540})
            await viewer.rest()

            def compensate(stops):
                return viewer.call("settings.patch",
                                   {"patch": {"exposure": {"compensation": stops}}})
            for stops in (1, 0, 1):
                await compensate(stops)
                await asyncio.sleep(0.02)  # a frame of it is being rendered
                _, back = await asyncio.gather(compensate(2), compensate(stops))
                await viewer.frame_where(
                    lambda frame, rev=back["rev"]: frame.header["state_rev"] >= rev, timeout=30)

    async def test_the_final_frame_can_be_a_png(self):
        async with Viewer(self.server) as viewer:
            state = await viewer.call("stream.configure", {"still": "png"})
            self.assertEqual(state["still"], "png")
            await viewer.call("camera.set", {"eye": [2, 2, 3]})
            final = await viewer.rest()
            self.assertEqual(final.header["codec"], 2)
            capture = await viewer.call("frame.capture")
            self.assertEqual(decode_png(final.payload).rgb,
                             decode_png(base64.b64decode(capture["data"])).rgb)

    async def test_statistics_report_the_idle_state(self):
        async with Viewer(self.server) as viewer:
            await viewer.call("stats.subscribe", {"interval_ms": 60000})
            await viewer.call("camera.set", {"eye": [2, 3, 3]})
            await viewer.rest()
            for _ in range(200):
                received = [note["params"] for note in viewer.notifications
                        if note["method"] == "stats.frame"]
                if received and received[-1]["state"] == "idle":
                    break
                await asyncio.sleep(0.05)
            last = received[-1]
            self.assertEqual(last["state"], "idle")
            self.assertEqual((last["codec"], last["quality"], last["scale"]), ("jpeg", 80, 1))

    async def test_the_final_frame_equals_the_capture(self):
        async with Viewer(self.server) as viewer:
            await viewer.call("camera.set", {"eye": [2, 2, 3]})
            seen = decode_jpeg((await viewer.rest()).payload)
            capture = await viewer.call("frame.capture")
            captured = decode_png(base64.b64decode(capture["data"]))
            self.assertLess(difference(seen, captured), 2)

    async def test_a_new_viewer_gets_the_frame_of_a_static_view(self):
        async with Viewer(self.server) as first:
            await first.call("camera.set", {"eye": [2, 3, 3]})
            static = await first.rest()
        async with Viewer(self.server) as second:
            frame = await second.next_frame(timeout=5)
            self.assertEqual(frame.header["render_id"], static.header["render_id"])
            self.assertEqual(frame.header["frame_seq"], 1)

    async def test_size_and_quality_take_effect(self):
        async with Viewer(self.server) as viewer:
            await viewer.rest()
            state = await viewer.call("stream.configure", {"width": 200, "height": 120})
            self.assertEqual((state["width"], state["height"]), (200, 120))
            frame = await viewer.frame_where(lambda frame: frame.header["width"] == 200)
            self.assertEqual(frame.header["height"], 120)
            huge = await viewer.call("stream.configure", {"width": 16384, "height": 16})
            self.assertEqual(huge["width"], viewer.hello["limits"]["max_width"])
            await viewer.call("stream.configure", {"width": 160, "height": 90, "quality": 30})
            await viewer.call("camera.set", {"eye": [3, 3, 2]})
            await viewer.frame_where(lambda frame: frame.header["quality"] == 30)

    async def test_a_paused_viewer_gets_nothing_until_it_resumes(self):
        async with Viewer(self.server) as viewer:
            await viewer.rest()
            self.assertTrue((await viewer.call("stream.pause"))["paused"])
            camera = await viewer.call("camera.set", {"eye": [1, 3, 3]})
            before = viewer.frames_received
            await asyncio.sleep(1)
            self.assertEqual(viewer.frames_received, before)
            self.assertFalse((await viewer.call("stream.resume"))["paused"])
            await viewer.frame_where(lambda frame: frame.header["state_rev"] >= camera["rev"])
            await viewer.rest()
            before = viewer.frames_received
            await viewer.call("stream.configure", {"paused": True})
            await viewer.call("stream.configure", {"paused": False})
            again = await viewer.next_frame()
            self.assertTrue(again.final, "only the final frame is sent again")
            await asyncio.sleep(0.5)
            self.assertEqual(viewer.frames_received, before + 1)

    async def test_max_fps_is_respected(self):
        async with Viewer(self.server) as viewer, viewer.moving():
            await viewer.call("stream.configure", {"max_fps": 4})
            await viewer.next_frame()
            begin, before = time.monotonic(), viewer.frames_received
            await asyncio.sleep(2)
            rate = (viewer.frames_received - before) / (time.monotonic() - begin)
            self.assertLessEqual(rate, 5)
            self.assertGreater(rate, 1)

    async def test_statistics_name_the_passes(self):
        async with Viewer(self.server) as viewer:
            self.assertEqual(await viewer.call("stats.subscribe", {"interval_ms": 50}),
                             {"interval_ms": 50})
            await viewer.call("camera.set", {"eye": [3, 3, 3]})
            stats = await viewer.notification("stats.frame")
            self.assertGreater(stats["frame_ms"], 0)
            self.assertGreater(stats["bytes"], 100)
            self.assertGreaterEqual(len(stats["passes"]), 3)
            self.assertLessEqual({entry["kind"] for entry in stats["passes"]}, {"device", "host"})


@compares_memory
class MemoryUse(ServerTestCase):
    async def test_memory_does_not_grow_with_the_number_of_frames(self):
        for scene in ("furnace", "mirror"):
            self.server.call("scene.load", {"name": scene})
            async with Viewer(self.server) as viewer, viewer.moving():
                await self.frames(viewer, 20)
                before = self.server.memory_bytes()
                await self.frames(viewer, 80)
                grown = self.server.memory_bytes() - before
            self.assertLess(grown, 40e6, scene)

    async def frames(self, viewer, count):
        for _ in range(count):
            await viewer.next_frame()


class SlowLinks(ServerTestCase):
    """A viewer behind a relay that passes only so many bytes a second."""

    async def relay(self, rate):
        async def pump(reader, writer, limit):
            with contextlib.suppress(ConnectionError):
                while data := await reader.read(4096):
                    writer.write(data)
                    await writer.drain()
                    if limit:
                        await asyncio.sleep(len(data) / limit)
            writer.close()

        async def serve(reader, writer):
            there = socket.socket()
            # Small, so that what waits here is felt by the server.
            there.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 8192)
            there.connect((self.server.host, self.server.port))
            server_reader, server_writer = await asyncio.open_connection(sock=there, limit=4096)
            await asyncio.gather(pump(reader, server_writer, None),
                                 pump(server_reader, writer, rate))
        return await asyncio.start_server(serve, "127.0.0.1", 0)

    async def test_frames_shrink_until_they_arrive_in_time(self):
        relay = await self.relay(rate=60_000)
        port = relay.sockets[0].getsockname()[1]
        async with relay:
            async with Viewer(self.server, port=port) as viewer, viewer.moving(20):
                await viewer.call("stream.configure",
                                  {"width": 320, "height": 180, "quality": 100, "max_fps": 10})
                await viewer.call("stats.subscribe", {"interval_ms": 200})
                chosen = []

                def is_lowered(frame):
                    return frame["scale"] < 1 or frame["quality"] <= 70
                # The goodput is a mean: what socket buffers took at once is in it for a while.
                begin, before = time.monotonic(), viewer.bytes_received
                for _ in range(600):
                    await asyncio.sleep(0.1)
                    chosen = [note["params"] for note in viewer.notifications
                              if note["method"] == "stats.frame"]
                    if chosen and is_lowered(chosen[-1]) and chosen[-1]["goodput"] < 200_000:
                        break
                else:
                    carried = (viewer.bytes_received - before) / (time.monotonic() - begin)
                    if carried < 40_000:
                        self.skipTest("the frame rate is too low here to fill the link")
                last = chosen[-1]
                print(f"quality {last['quality']}, scale {last['scale']}, "
                      f"{chosen[0]['round_trip_ms']:.0f} -> {last['round_trip_ms']:.0f} ms ",
                      end="")
                self.assertLess((last["scale"], last["quality"]), (1, 100))
                self.assertEqual(last["state"], "interactive")
                self.assertLess(last["goodput"], 200_000)
                await viewer.call("stream.configure", {"quality": 80, "max_fps": 60})


class LongRoundTrips(ServerTestCase):
    """A viewer behind a relay that delays everything but holds nothing up."""

    async def relay(self, delay):
        async def pump(reader, writer):
            passing = asyncio.Queue()

            async def pass_on():
                while True:
                    due, data = await passing.get()
                    await asyncio.sleep(max(0, due - time.monotonic()))
                    if not data:
                        return writer.close()
                    writer.write(data)
            passer = asyncio.create_task(pass_on())
            with contextlib.suppress(ConnectionError):
                while data := await reader.read(65536):
                    passing.put_nowait((time.monotonic() + delay, data))
            passing.put_nowait((0, b""))
            await passer

        async def serve(reader, writer):
            there = await asyncio.open_connection(self.server.host, self.server.port)
            await asyncio.gather(pump(reader, there[1]), pump(there[0], writer))
        return await asyncio.start_server(serve, "127.0.0.1", 0)

    async def test_a_long_round_trip_does_not_reduce_the_frame_rate(self):
        relay = await self.relay(delay=0.075)
        async with relay, Viewer(self.server) as near, near.moving(), \
                Viewer(self.server, port=relay.sockets[0].getsockname()[1]) as far:
            best = 0
            # It takes a while to learn that the way is long, not narrow.
            for second in range(12):
                before = near.frames_received, far.frames_received
                await asyncio.sleep(1)
                there = far.frames_received - before[1]
                best = max(best, there / max(1, near.frames_received - before[0]))
                if best > 0.75:
                    break
        print(f"{there} frames/s at 150 ms, {best:.0%} of a near viewer's, after {second + 1} s ",
              end="")
        self.assertGreater(best, 0.55)


class SlowViewers(ServerTestCase):
    async def rate(self, viewer, seconds):
        """Over this many seconds, and longer if the frame rate is too low to count."""
        begin, before = time.monotonic(), viewer.frames_received
        for _ in range(10):
            await asyncio.sleep(seconds)
            if viewer.frames_received - before >= 10 * seconds:
                break
        return (viewer.frames_received - before) / (time.monotonic() - begin)

    async def test_a_viewer_that_does_not_acknowledge_gets_a_window_and_later_the_latest(self):
        async with Viewer(self.server, acknowledge=False) as lazy, \
                Viewer(self.server) as brisk, brisk.moving():
            window = lazy.hello["limits"]["ack_window"]
            for _ in range(window):
                last = await lazy.next_frame()
            await self.rate(brisk, 2)
            self.assertEqual(lazy.frames_received, window)
            newest = (await brisk.next_frame()).header["render_id"]
            while not brisk.frames.empty():
                newest = brisk.frames.get_nowait().header["render_id"]
            await lazy.notify("stream.ack", {"frame_seq": last.header["frame_seq"]})
            fresh = await lazy.next_frame()
            self.assertGreaterEqual(fresh.header["render_id"], newest)
            self.assertTrue(fresh.header["flags"] & FLAG_FIRST_AFTER_DROP)
            self.assertGreater(fresh.header["frame_seq"], last.header["frame_seq"] + 1)

    async def test_a_stalled_viewer_does_not_slow_down_others(self):
        async with Viewer(self.server) as brisk, brisk.moving():
            await brisk.call("stream.configure", {"width": 320, "height": 180, "quality": 100})
            await self.rate(brisk, 1)
            # Again where something else on the machine used the CPU in between.
            for _ in range(3):
                alone = await self.rate(brisk, 3)
                async with Viewer(self.server) as stalled:
                    transport = stalled.socket.transport
                    transport.pause_reading()
                    await self.rate(brisk, 1)
                    memory = self.server.memory_bytes()
                    beside = await self.rate(brisk, 3)
                    grown = self.server.memory_bytes() - memory
                    transport.resume_reading()
                print(f"frames a second: {alone:.1f} alone, {beside:.1f} beside a stalled viewer; "
                      f"memory {grown / 1e6:+.1f} MB ", end="")
                if beside > 0.7 * alone:
                    break
            # Encoding is shared, so only the noise of a busy machine is allowed for.
            self.assertGreater(beside, 0.7 * alone)
            assert_less_memory(self, grown, 20e6)

    async def test_viewers_that_vanish_during_a_frame_are_removed(self):
        async with Viewer(self.server) as stays, stays.moving():
            for _ in range(5):
                viewer = Viewer(self.server)
                await viewer.__aenter__()
                await viewer.call("stream.configure", {"quality": 100})
                await viewer.next_frame()
                viewer.socket.transport.abort()
            before = stays.frames_received
            await self.rate(stays, 1)
            self.assertGreater(stays.frames_received, before)
            await self.until_viewers(1)

    async def until_viewers(self, count):
        for _ in range(100):
            metrics = self.server.get("/metrics")[2].decode()
            if f"heliograph_viewers {count}\n" in metrics:
                return
            await asyncio.sleep(0.1)
        self.fail(f"there are not {count} viewers:\n{metrics}")

    async def test_viewers_without_acknowledgements_are_disconnected(self):
        async with Viewer(self.server, acknowledge=False) as lazy, Viewer(self.server) as brisk:
            await lazy.next_frame()
            code, reason = await lazy.closed(timeout=20)
            self.assertEqual(code, 4004, reason)
            await brisk.call("camera.get")

    async def test_invalid_acknowledgements_are_refused(self):
        async with Viewer(self.server) as viewer:
            for seq in (0, 7, 4294967295):
                await viewer.notify("stream.ack", {"frame_seq": seq})
            answer = await viewer.ask("stream.ack", {"frame_seq": -1})
            self.assert_error(answer, -32602, path="frame_seq")
            await viewer.next_frame()
