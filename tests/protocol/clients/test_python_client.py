"""The Python client library and its example programs."""

import asyncio
import os
import re
import subprocess
import sys
import tempfile
import threading
import time
import unittest
import xml.etree.ElementTree

import numpy

from harness.exposition import parse
from harness.images import decode_jpeg, decode_png
from harness.server import Server, ServerTestCase
from test_lockstep import make_scenes

PROTOCOL = os.path.normpath(os.path.join(os.path.dirname(__file__), "..", "..", "..", "protocol"))
LIBRARY = os.path.join(PROTOCOL, "python")
sys.path.insert(0, LIBRARY)

import heliograph  # noqa: E402

TOKEN = "a-token-of-the-library"
SILENCE = 12.0  # seconds; the server waits 10 for an acknowledgement


class IdleClients:
    """Programs that have connected and ask for nothing for a while, beside the other tests."""

    def __init__(self):
        self.server = Server("--scene", "mirror")
        self.never = heliograph.connect(self.server.url)
        self.once = heliograph.connect(self.server.url)
        self.first = self.once.next_frame()
        self.since = time.monotonic()

    def wait(self):
        time.sleep(max(0.0, self.since + SILENCE - time.monotonic()))

    def close(self):
        with self.server:
            self.never.close()
            self.once.close()


def setUpModule():
    global thinkers
    thinkers = IdleClients()


def tearDownModule():
    thinkers.close()


def frames_sent(server):
    return parse(server.get("/metrics")[2].decode())["heliograph_frames_sent_total"].samples["", ()]


class Generated(ServerTestCase):
    def setUp(self):
        pass

    def test_the_generated_methods_are_up_to_date(self):
        schema = subprocess.run([os.environ["HELIOGRAPH_BINARY"], "schema"], check=True,
                                capture_output=True).stdout
        made = subprocess.run([sys.executable, os.path.join(LIBRARY, "generate.py")], check=True,
                              input=schema, capture_output=True).stdout.decode()
        with open(os.path.join(LIBRARY, "heliograph", "methods.py"), encoding="utf-8") as file:
            self.assertEqual(file.read(), made, "run protocol/python/generate.py")

    def test_every_method_has_a_wrapper_that_calls_it(self):
        calls = []
        methods = heliograph.client.Methods(lambda name, params: calls.append((name, params)))
        for method in self.server.call("rpc.discover")["methods"]:
            function = methods
            for part in method["name"].split("."):
                function = getattr(function, part)
            params = {param["name"]: param["value"] for param in method["examples"][0]["params"]}
            function(**params)
            self.assertEqual(calls.pop(), (method["name"], params))
            self.assertTrue(function.__doc__)


class Library(ServerTestCase):
    def connect(self):
        return heliograph.connect(self.server.url, name="library test")

    def test_calls_and_errors(self):
        with self.connect() as view:
            self.assertEqual(view.info["protocol"], "heliograph.v1")
            self.assertEqual(view.scene.info()["name"], "mirror")
            moved = view.camera.set(eye=[1, 2, 3])
            self.assertEqual(moved["eye"], [1, 2, 3])
            with self.assertRaises(heliograph.HeliographError) as refused:
                view.camera.set(vertical_fov=500)
            error = refused.exception
            self.assertEqual((error.code, error.path), (-32602, "vertical_fov"))
            self.assertIn("170", error.limit)

    def test_objects_say_what_they_are(self):
        with self.connect() as view:
            for part in ("heliograph.Client", self.server.url, "session main", "llvmpipe"):
                self.assertIn(part, repr(view))
            self.assertRegex(repr(view.camera), "^<camera: .*orbit")
        self.assertIn("closed", repr(view))

    def test_captures_in_every_format(self):
        with self.connect() as view:
            image = view.capture(samples=1)
            self.assertEqual(decode_png(image._repr_png_()).width, 160)
            self.assertIsNone(image._repr_jpeg_())
            self.assertEqual(decode_png(view._repr_png_()).height, 90)
            self.assertTrue(decode_jpeg(view.capture(format="jpeg", samples=1)._repr_jpeg_()))
            pixels = view.array(samples=1)
            self.assertEqual((pixels.shape, pixels.dtype), ((90, 160, 3), numpy.uint8))
            depth = view.array("gbuffer.motion.view_z", samples=1)
            self.assertEqual((depth.shape, depth.dtype), ((90, 160), numpy.float32))
            with self.assertRaises(ValueError):
                image.numpy()
            with tempfile.TemporaryDirectory() as folder:
                image.save(os.path.join(folder, "image.png"))
                with open(os.path.join(folder, "image.png"), "rb") as file:
                    self.assertEqual(file.read(), image.data)

    def test_frames_until_the_final_one(self):
        with self.connect() as view:
            frames = [view.next_frame()]
            while not frames[-1].final:
                frames.append(view.next_frame())
            self.assertTrue(decode_jpeg(frames[-1]._repr_jpeg_()).full_chroma)
            self.assertGreaterEqual(frames[-1].samples, 4)
            view.stop_frames()
            view.camera.orbit(yaw=10)
            with self.assertRaises(asyncio.TimeoutError):
                view.next_frame(timeout=0.0)

    def test_frames_carry_depth_where_it_was_requested(self):
        with self.connect() as view:
            view.stream.configure(width=320, height=184)
            self.assertIsNone(view.next_frame().depth)
            self.assertTrue(view.stream.configure(depth=True)["depth"])
            frame = view.next_frame()
            while not frame.depth:
                frame = view.next_frame()
            depth = frame.depth
            self.assertEqual((depth.width, depth.height), (64, 37))
            camera = view.camera.get()
            numpy.testing.assert_allclose(depth.eye, camera["eye"], rtol=1e-6)
            numpy.testing.assert_allclose(depth.target, camera["target"], atol=1e-6)
            self.assertAlmostEqual(depth.vertical_fov, camera["vertical_fov"], places=4)
            view_z = view.array("gbuffer.motion.view_z")
            surfaces = 0
            for row in range(depth.height):
                for column in range(depth.width):
                    top, left = int(row * 184 / 37), column * 5
                    # The samples of a frame lie elsewhere in their pixels.
                    block = view_z[max(0, top - 1):top + 7, max(0, left - 1):left + 6]
                    sample = depth.view_z(column, row)
                    self.assertGreaterEqual(sample, 0.9 * block.min())
                    self.assertLessEqual(sample, 1.1 * block.max())
                    surfaces += sample < 1e6
            self.assertGreater(surfaces, 100)
            self.assertIsNotNone(frame._repr_jpeg_())

    def test_lockstep(self):
        with self.connect() as view:
            self.assertEqual(view.step(2, 0.1)["frames"], 2)
            self.assertAlmostEqual(view.step(1, 0.1)["seconds"], 0.3)
            self.assertFalse(view.frame.run()["lockstep"])

    def test_notifications(self):
        heard = threading.Event()
        with self.connect() as view, self.connect() as other:
            end = view.listen("camera.changed", lambda params: heard.set())
            other.camera.orbit(yaw=5)
            self.assertTrue(heard.wait(5))
            end()

    async def test_asyncio(self):
        async with await heliograph.connect_async(self.server.url) as view:
            scenes, camera = await asyncio.gather(view.scene.list(), view.camera.get())
            self.assertEqual(scenes["current"], "mirror")
            self.assertIn("eye", camera)
            self.assertEqual((await view.array(samples=1)).shape, (90, 160, 3))
            self.assertEqual((await view.next_frame()).width, 160)

    def test_the_end_of_the_server_fails_pending_calls(self):
        with Server("--scene", "mirror") as server:
            view = heliograph.connect(server.url)
            server.stop()
            with self.assertRaises(ConnectionError):
                view.scene.list()
            view.close()

    def test_a_slow_program_gets_fewer_but_recent_frames(self):
        with self.connect() as view:
            view.next_frame()
            before = frames_sent(self.server)
            for _ in range(40):
                moved = self.server.call("camera.orbit", {"yaw": 2})
                time.sleep(0.02)
            self.assertLessEqual(frames_sent(self.server) - before, 8)
            taken = 1
            while view.next_frame().header["state_rev"] < moved["rev"]:
                taken += 1
            # The newest that had come, one that waited in the server, one drawn since.
            self.assertLessEqual(taken, 3)

    def test_a_token(self):
        with Server("--scene", "mirror", "--token", TOKEN) as server:
            with heliograph.connect(server.url, token=TOKEN) as view:
                self.assertEqual(view.scene.list()["current"], "mirror")
            with self.assertRaises(Exception):
                heliograph.connect(server.url, token="another-token-altogether")


class Readme(unittest.TestCase):
    def test_the_client_on_the_page_works(self):
        with open(os.path.join(PROTOCOL, "README.md"), encoding="utf-8") as file:
            blocks = re.findall("```python\n(.*?)```", file.read(), re.DOTALL)
        code = next(block for block in blocks if "asyncio.run" in block)
        with Server("--scene", "mirror", "--set", "accumulation.max_samples=16") as server, \
                tempfile.TemporaryDirectory() as folder:
            code = code.replace("127.0.0.1:8080", f"{server.host}:{server.port}")
            done = subprocess.run([sys.executable, "-c", code], cwd=folder, capture_output=True,
                                  text=True, timeout=60)
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertIn('"viewer"', done.stdout)
            with open(os.path.join(folder, "frame.jpg"), "rb") as file:
                self.assertEqual(decode_jpeg(file.read()).width, 640)

    def test_the_program_on_the_front_page_works(self):
        with open(os.path.join(PROTOCOL, "../README.md"), encoding="utf-8") as file:
            code, = re.findall("```python\n(.*?)```", file.read(), re.DOTALL)
        with Server("--scene", "mirror") as server, tempfile.TemporaryDirectory() as folder:
            code = code.replace("127.0.0.1:8080", f"{server.host}:{server.port}")
            path = os.path.join(PROTOCOL, "python")
            done = subprocess.run([sys.executable, "-c", code], cwd=folder, capture_output=True,
                                  text=True, timeout=120, env={**os.environ, "PYTHONPATH": path})
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertIn("(360, 640)", done.stdout)
            self.assertTrue(os.path.exists(os.path.join(folder, "view.png")))


class Examples(ServerTestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        scenes = os.path.join(cls.folder.name, "scenes")
        os.makedirs(os.path.join(scenes, "props"))
        make_scenes(scenes)
        os.rename(os.path.join(scenes, "mirror.glb"), os.path.join(scenes, "props", "mirror.glb"))
        with open(os.path.join(scenes, "props", "broken.glb"), "wb") as file:
            file.write(b"nothing")
        cls.server = Server("--scene", "hopping", "--token", TOKEN, scenes=scenes)
        cls.server.headers = {"Authorization": "Bearer " + TOKEN}

    def setUp(self):
        pass

    def state(self):
        """What of the server a program must leave as it is."""
        state = {name: self.server.call(name) for name in
                 ("scene.list", "camera.get", "settings.get", "materials.list")}
        state["sessions"] = [(one["name"], one["width"], one["height"])
                             for one in self.server.call("session.list")["sessions"]]
        return state

    def run_example(self, name, *arguments, environment=None):
        return subprocess.run(
            [sys.executable, os.path.join(PROTOCOL, "examples", name + ".py"), "--url",
             self.server.url, *arguments], cwd=self.folder.name, capture_output=True, text=True,
            env={**os.environ, "PYTHONPATH": LIBRARY, "HELIOGRAPH_TOKEN": TOKEN,
                 **(environment or {})}, timeout=60)

    def run_aside(self, name, *arguments, returns=0):
        """Runs one in a session of its own, which is closed afterwards."""
        before = self.state()
        done = self.run_example(name, *arguments)
        self.assertEqual(done.returncode, returns, done.stdout + done.stderr)
        self.assertEqual(self.state(), before)
        return done

    def path(self, *parts):
        return os.path.join(self.folder.name, *parts)

    def image(self, *parts):
        with open(self.path(*parts), "rb") as file:
            return decode_png(file.read())

    def test_turntable(self):
        arguments = ("--scene", "hopping", "--size", "64", "36", "--images", "4",
                     "--frames-each", "2", "--folder")
        for folder in ("turn", "again"):
            self.run_aside("turntable", *arguments, folder)
        self.assertEqual(sorted(os.listdir(self.path("turn"))),
                         ["000.png", "001.png", "002.png", "003.png"])
        images = [self.image("turn", f"{i:03d}.png").rgb for i in range(4)]
        self.assertEqual(len(set(images)), 4)
        self.assertEqual(images, [self.image("again", f"{i:03d}.png").rgb for i in range(4)])

    def test_thumbnails(self):
        done = self.run_aside("thumbnails", "--models", "props", "--size", "48", "--samples", "2",
                              "--folder", "thumbs")
        self.assertIn("props/broken", done.stderr)
        self.assertEqual(os.listdir(self.path("thumbs", "props")), ["mirror.png"])
        self.assertEqual(self.image("thumbs", "props", "mirror.png").width, 48)

    def test_roughness_sweep(self):
        self.server.call("session.create", {"name": "sweep", "copy_of": "main", "width": 64,
                                            "height": 36})
        done = self.run_aside("roughness_sweep", "--material", "metal_000", "--steps", "3",
                              "--size", "64", "36", "--samples", "6", "--session", "sweep")
        settings = self.server.call("settings.get", session="sweep")["settings"]
        self.assertEqual(settings["accumulation"]["max_samples"], 6, "what it asks for")
        self.server.call("session.close", {"session": "sweep"})
        self.assertEqual(done.stdout.count("roughness"), 3)
        root = xml.etree.ElementTree.parse(self.path("sweep.svg")).getroot()
        lines = root.findall("{http://www.w3.org/2000/svg}polyline")
        self.assertEqual([len(line.get("points").split()) for line in lines], [3, 3])

    def test_visual_regression(self):
        arguments = ("--scene", "hopping", "--size", "64", "36", "--frames", "2", "--folder",
                     "expected")
        self.run_aside("visual_regression", *arguments, "--update")
        done = self.run_aside("visual_regression", *arguments)
        self.assertIn("same, 0.0000", done.stdout)
        kept = next(name for name in os.listdir(self.path("expected")) if name.endswith(".npy"))
        pixels = numpy.load(self.path("expected", kept))
        numpy.save(self.path("expected", kept), 255 - pixels)
        done = self.run_aside("visual_regression", *arguments, returns=1)
        self.assertIn("DIFFERENT", done.stdout)
        self.assertTrue(os.path.exists(self.path("expected", kept[:-4] + ".actual.png")))

    def test_own_session_survives_a_killed_program(self):
        self.server.call("session.create", {"name": "shared", "copy_of": "main"})
        in_the_way = self.path("dying", "001.png")
        os.makedirs(in_the_way)
        done = self.run_example(
            "turntable", "--session", "shared", "--size", "64", "36", "--images", "4",
            "--frames-each", "2", "--folder", "dying", "--token", TOKEN,
            environment={"HELIOGRAPH_TOKEN": "not-the-right-token"})
        self.assertEqual(done.returncode, 1, done.stderr)
        self.assertIn("001.png", done.stderr)
        info = self.server.call("session.info", session="shared")
        self.assertEqual((info["width"], info["height"]), (64, 36))
        # Frames are rendered again without steps.
        images = set()
        for _ in range(2):
            self.server.call("camera.orbit", {"yaw": 60}, "shared")
            images.add(self.server.call("frame.capture", {"samples": 1}, "shared")["data"])
        self.assertEqual(len(images), 2)
        self.server.call("session.close", {"session": "shared"})

    def test_without_the_token(self):
        done = self.run_example("turntable", environment={"HELIOGRAPH_TOKEN": ""})
        self.assertEqual(done.returncode, 1)
        self.assertIn("401", done.stderr)


class IdleClient(unittest.TestCase):
    """Comes last: the time that it needs has passed by then."""

    def test_an_idle_client_stays_connected_and_costs_no_rendering(self):
        thinkers.wait()
        for view in (thinkers.never, thinkers.once):
            self.assertEqual(view.scene.list()["current"], "mirror")
        before = frames_sent(thinkers.server)
        for _ in range(20):
            moved = thinkers.server.call("camera.orbit", {"yaw": 2})
            time.sleep(0.02)
        self.assertEqual(frames_sent(thinkers.server), before)
        frame = thinkers.once.next_frame()
        self.assertGreater(frame.header["frame_seq"], thinkers.first.header["frame_seq"])
        while frame.header["state_rev"] < moved["rev"]:
            frame = thinkers.once.next_frame()
        self.assertEqual(thinkers.never.next_frame().width, 160)
