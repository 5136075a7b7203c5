"""Video over the WebSocket and Motion JPEG over HTTP, decoded by ffmpeg."""

import asyncio
import base64
import functools
import http.client
import math
import os
import shutil
import signal
import subprocess
import tempfile
import unittest

from harness.images import Image, decode_jpeg, decode_png
from harness.server import Server, ServerTestCase
from harness.viewer import FLAG_FIRST_AFTER_DROP, FLAG_KEY, Viewer

JPEG, H264 = 1, 16
FFMPEG = shutil.which("ffmpeg")
VLC = shutil.which("cvlc")
# VLC does not run as root.
AS_UNPRIVILEGED = ["setpriv", "--reuid", "65534", "--regid", "65534", "--clear-groups"]


class VideoViewer(Viewer):
    """Says that it decodes H.264."""

    def __init__(self, server, codecs=("h264", "jpeg"), **more):
        super().__init__(server, greet=False, **more)
        self.codecs = list(codecs)

    async def __aenter__(self):
        await super().__aenter__()
        self.hello = await self.call("hello", {"client": "video tests", "codecs": self.codecs})
        return self

    async def video_frames(self, count):
        """So many H.264 frames, others skipped."""
        return [await self.frame_where(lambda frame: frame.header["codec"] == H264)
                for _ in range(count)]


def encoded_us(header):
    """When the frame was encoded, on the server's clock."""
    return header["render_start_us"] + header["render_us"] + header["encode_us"]


def decode_video(units, width, height):
    """All images of an H.264 stream, by ffmpeg, which must not complain."""
    command = [FFMPEG, "-loglevel", "warning", "-f", "h264", "-i", "-", "-fps_mode", "passthrough",
               "-f", "rawvideo", "-pix_fmt", "rgb24", "-"]
    done = subprocess.run(command, input=b"".join(units), capture_output=True, timeout=60,
                          check=True)
    complaints = [line for line in done.stderr.decode().splitlines() if "deprecated" not in line]
    assert not complaints, complaints
    size = 3 * width * height
    assert len(done.stdout) % size == 0
    return [Image(width, height, done.stdout[i:i + size])
            for i in range(0, len(done.stdout), size)]


def signal_to_noise(a, b):
    error = sum((x - y) ** 2 for x, y in zip(a.rgb, b.rgb)) / len(a.rgb)
    return 10 * math.log10(255 ** 2 / max(error, 1e-9))


def needs_video(test):
    @functools.wraps(test)
    async def run(self):
        async with VideoViewer(self.server) as viewer:
            if "h264" not in viewer.hello["codecs"]:
                self.assertTrue(viewer.hello["codec_reason"])
                self.skipTest(viewer.hello["codec_reason"])
            await test(self, viewer)
    return run


class Video(ServerTestCase):
    @needs_video
    async def test_moving_frames_are_video_and_the_final_frame_is_an_image(self, viewer):
        self.assertEqual(viewer.hello["codecs"], ["h264", "jpeg"])
        self.assertIsNone(viewer.hello["codec_reason"])
        async with viewer.moving():
            first = await viewer.frame_where(
                lambda frame: frame.header["codec"] == H264 and frame.header["width"] == 160)
            frames = await viewer.video_frames(8)
        self.assertTrue(first.header["flags"] & FLAG_KEY)
        for frame in frames:
            self.assertFalse(frame.header["flags"] & FLAG_KEY)
            self.assertEqual((frame.header["width"], frame.header["height"]), (160, 90))
        final = await viewer.rest()
        self.assertEqual(final.header["codec"], JPEG)
        self.assertTrue(decode_jpeg(final.payload).full_chroma)
        async with viewer.moving():
            again = await viewer.video_frames(2)
        self.assertFalse(again[0].header["flags"] & FLAG_KEY, "the video goes on where it was")

    @unittest.skipUnless(FFMPEG, "ffmpeg is not installed")
    @needs_video
    async def test_decoded_video_matches_the_capture(self, viewer):
        # A buffer without noise, so that one sample is exact.
        await viewer.call("settings.patch", {"patch": {"view": {"buffer": "gbuffer.base_color"},
                                                       "antialiasing": {"temporal": False, "jitter": False}}})
        await viewer.call("stream.configure", {"quality": 95})
        frames = []
        for seq in range(1, 60):
            # The last one shows where the camera stays.
            await viewer.notify("camera.set", {"eye": [3, 1 + 0.02 * seq, 2], "seq": seq})
            while True:
                frame = await viewer.next_frame()
                # The first frame may still have the size that a viewer before has set.
                if frame.header["codec"] == H264 and frame.header["width"] == 160:
                    frames.append(frame)
                if frame.header["input_seq_echo"] >= seq:
                    break
            if len(frames) >= 12 and frame.header["codec"] == H264:
                break
        images = decode_video([frame.payload for frame in frames], 160, 90)
        self.assertEqual(len(images), len(frames))
        self.assertGreater(len({image.rgb for image in images}), 4, "it does not move")
        capture = await viewer.call("frame.capture", {"buffer": "gbuffer.base_color"})
        reference = decode_png(base64.b64decode(capture["data"]))
        ratio = signal_to_noise(images[-1], reference)
        print(f"{ratio:.1f} dB ", end="")
        self.assertGreater(ratio, 28)

    @needs_video
    async def test_new_viewers_do_not_force_key_frames_at_once(self, viewer):
        # So slowly that viewers, newcomers too, lose few frames on a busy machine.
        async with viewer.moving(rate=15):
            received = []
            while sum(frame.header["codec"] == H264 for frame in received) < 3:
                received.append(await viewer.next_frame())
            for _ in range(2):
                async with VideoViewer(self.server) as newcomer:
                    first = await newcomer.next_frame()
                    self.assertTrue(first.header["flags"] & FLAG_KEY, "a JPEG, or a key frame")
                    joined = [first] if first.header["codec"] == H264 else []
                    joined += await newcomer.video_frames(4 - len(joined))
                    self.assertTrue(joined[0].header["flags"] & FLAG_KEY)
                    self.check_key_intervals([frame.header for frame in joined])
            received.append(await viewer.next_frame())
            while not viewer.frames.empty():
                received.append(viewer.frames.get_nowait())
        keys = self.check_key_intervals([frame.header for frame in received])
        self.assertGreaterEqual(len(keys), 2, "newcomers join the same video")

    def check_key_intervals(self, headers):
        """Key frames of one video are seconds apart, unless the viewer lost a frame between them.

        @return the headers of key frames
        """
        keys = []
        lost = False
        for header in headers:
            lost |= bool(header["flags"] & FLAG_FIRST_AFTER_DROP)
            if header["codec"] != H264 or not header["flags"] & FLAG_KEY:
                continue
            # Another size or quality, which a busy machine may bring, is another video.
            same_video = keys and all(keys[-1][name] == header[name]
                                      for name in ("width", "height", "quality"))
            if same_video and not lost:
                self.assertGreater(encoded_us(header) - encoded_us(keys[-1]), 1.9e6)
            keys.append(header)
            lost = False
        return keys

    @needs_video
    async def test_a_change_of_size_starts_a_new_video(self, viewer):
        async with viewer.moving():
            await viewer.video_frames(2)
            await viewer.call("stream.configure", {"width": 200, "height": 121})
            changed = await viewer.frame_where(
                lambda frame: frame.header["codec"] == H264 and frame.header["width"] == 200)
            self.assertTrue(changed.header["flags"] & FLAG_KEY)
            self.assertEqual(changed.header["height"], 120, "of an odd height one row is missing")

    @needs_video
    async def test_the_codec_can_be_changed(self, viewer):
        state = await viewer.call("stream.configure", {"codec": "jpeg"})
        self.assertEqual(state["codec"], "jpeg")
        await viewer.rest()
        async with viewer.moving():
            self.assertEqual((await viewer.next_frame()).header["codec"], JPEG)
            for _ in range(3):
                self.assertEqual((await viewer.next_frame()).header["codec"], JPEG)
            await viewer.call("stream.configure", {"codec": "h264"})
            await viewer.video_frames(2)

    async def test_clients_without_the_codec_get_no_video(self):
        async with Viewer(self.server) as viewer:
            answer = await viewer.ask("stream.configure", {"codec": "h264"})
            self.assert_error(answer, -32602, path="codec")

    async def test_an_unknown_codec_is_skipped_and_named(self):
        async with VideoViewer(self.server, ["av1", "jpeg"]) as viewer:
            self.assertEqual(viewer.hello["codecs"], ["jpeg"])
            self.assertIn("av1", viewer.hello["codec_reason"])


def read_file(path):
    with open(path, "rb") as file:
        return file.read()


class Parts:
    """Reads multipart/x-mixed-replace as its bytes come."""

    def __init__(self, server, path="/api/v1/sessions/main/stream.mjpg", timeout=20, **headers):
        self.connection = http.client.HTTPConnection(server.host, server.port, timeout=timeout)
        self.connection.request("GET", path, headers=headers)
        self.response = self.connection.getresponse()
        self.received = b""

    def until(self, mark):
        while mark not in self.received:
            more = self.response.read1(65536)
            if not more:
                raise EOFError(self.received[-80:])
            self.received += more
        before, _, self.received = self.received.partition(mark)
        return before

    def image(self):
        """The next part, once the header of the one after it is there."""
        self.until(b"--frame\r\nContent-Type: image/jpeg\r\n\r\n")
        file = self.until(b"\r\n--frame\r\nContent-Type: image/jpeg\r\n\r\n")
        self.received = b"--frame\r\nContent-Type: image/jpeg\r\n\r\n" + self.received
        return decode_jpeg(file)

    def close(self):
        self.response.close()  # which has taken the socket over: nothing else comes on it


class MjpegStream(ServerTestCase):
    async def test_parts_are_complete_images_and_follow_the_camera(self):
        # Blocking reads in a thread: the loop goes on with the other viewer.
        parts = await asyncio.to_thread(Parts, self.server)
        self.assertEqual(parts.response.status, 200)
        self.assertEqual(parts.response.getheader("content-type"),
                         "multipart/x-mixed-replace; boundary=frame")
        self.assertEqual(parts.response.getheader("cache-control"), "no-store")
        first = await asyncio.to_thread(parts.image)
        self.assertEqual((first.width, first.height), (160, 90))
        async with Viewer(self.server) as viewer, viewer.moving():
            for _ in range(5):
                await asyncio.to_thread(parts.image)
        parts.close()
        self.server.wait_for(lambda: b"heliograph_viewers 0\n" in self.server.get("/metrics")[2],
                             "the viewer's departure")

    async def test_the_stream_requires_a_token(self):
        for path, headers, status in (
                ("/api/v1/sessions/nowhere/stream.mjpg", {}, 404),
                ("/api/v1/sessions/main/stream.mjpg?quality=abc", {}, 400),
                ("/api/v1/sessions/main/stream.mjpg?max_fps=241", {}, 400),
                ("/api/v1/sessions/main/stream.mjpg", {"Origin": "http://evil.example"}, 403),
                ("/api/v1/sessions/main/stream.mjpg", {"Host": "evil.example"}, 403)):
            self.assertEqual(self.server.get(path, **headers)[0], status, path)

    @unittest.skipUnless(FFMPEG, "ffmpeg is not installed")
    async def test_ffmpeg_decodes_it(self):
        url = f"{self.server.url}api/v1/sessions/main/stream.mjpg?quality=90"
        async with Viewer(self.server) as viewer, viewer.moving():
            process = await asyncio.create_subprocess_exec(
                FFMPEG, "-loglevel", "error", "-f", "mpjpeg", "-i", url, "-frames:v", "6",
                "-f", "rawvideo", "-pix_fmt", "rgb24", "-", stdout=subprocess.PIPE,
                stderr=subprocess.PIPE)
            output, complaints = await asyncio.wait_for(process.communicate(), 60)
        self.assertEqual(len(output), 6 * 3 * 160 * 90, complaints)
        image = Image(160, 90, output[-3 * 160 * 90:])
        self.assertGreater(image.deviation(), 5)

    @unittest.skipUnless(VLC, "cvlc is not installed (Debian: vlc-bin, vlc-plugin-base)")
    async def test_vlc_plays_it(self):
        url = f"{self.server.url}api/v1/sessions/main/stream.mjpg"
        with tempfile.TemporaryDirectory() as folder:
            os.chmod(folder, 0o777)

            def newest():
                names = sorted(name for name in os.listdir(folder) if name.endswith(".png"))
                return [read_file(os.path.join(folder, name)) for name in names[-1:]]
            shown = set()
            async with Viewer(self.server) as viewer, viewer.moving():
                player = await asyncio.create_subprocess_exec(
                    *(AS_UNPRIVILEGED if os.geteuid() == 0 else []), "env", f"HOME={folder}",
                    VLC, "--intf", "dummy", "--no-audio", "--vout", "dummy", "--video-filter",
                    "scene", "--scene-format", "png", "--scene-ratio", "1", "--scene-path", folder,
                    url, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
                try:
                    for _ in range(600):
                        shown.update(newest())
                        if len(shown) > 3 or player.returncode is not None:
                            break
                        await asyncio.sleep(0.1)
                finally:
                    if player.returncode is None:
                        player.kill()
                    await player.wait()
        self.assertGreater(len(shown), 3, f"VLC ended with {player.returncode}")
        for image in map(decode_png, shown):
            # It writes whole blocks of 16 rows.
            self.assertEqual((image.width, image.height), (160, 96))
            self.assertGreater(image.deviation(), 5)


class MjpegStreamAtShutdown(unittest.TestCase):
    def test_draining_ends_the_stream_between_parts(self):
        with Server() as server:
            parts = Parts(server)
            parts.until(b"\r\n--frame\r\n")
            server.process.send_signal(signal.SIGTERM)
            parts.until(b"\r\n--frame--\r\n")
            self.assertEqual(parts.response.read(), b"")
            parts.close()
            self.assertEqual(server.stop(), 0)
