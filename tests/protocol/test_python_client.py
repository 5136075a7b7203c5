"""The client library in Python, and the programs that show how to use it."""

import asyncio
import os
import re
import subprocess
import sys
import tempfile
import threading
import unittest
import xml.etree.ElementTree

import numpy

from harness.pictures import decode_jpeg, decode_png
from harness.server import Server, ServerTestCase
from test_lockstep import make_scenes

PROTOCOL = os.path.normpath(os.path.join(os.path.dirname(__file__), "..", "..", "protocol"))
LIBRARY = os.path.join(PROTOCOL, "python")
sys.path.insert(0, LIBRARY)

import heliograph  # noqa: E402


class Generated(ServerTestCase):
    def setUp(self):
        pass

    def test_the_wrappers_are_those_of_this_server(self):
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

    def test_captures_in_every_form(self):
        with self.connect() as view:
            picture = view.capture(samples=1)
            self.assertEqual(decode_png(picture._repr_png_()).width, 160)
            self.assertIsNone(picture._repr_jpeg_())
            self.assertEqual(decode_png(view._repr_png_()).height, 90)
            self.assertTrue(decode_jpeg(view.capture(format="jpeg", samples=1)._repr_jpeg_()))
            pixels = view.array(samples=1)
            self.assertEqual((pixels.shape, pixels.dtype), ((90, 160, 3), numpy.uint8))
            depth = view.array("gbuffer.motion.view_z", samples=1)
            self.assertEqual((depth.shape, depth.dtype), ((90, 160), numpy.float32))
            with self.assertRaises(ValueError):
                picture.numpy()
            with tempfile.TemporaryDirectory() as folder:
                picture.save(os.path.join(folder, "picture.png"))
                with open(os.path.join(folder, "picture.png"), "rb") as file:
                    self.assertEqual(file.read(), picture.data)

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

    def test_the_end_of_the_server_ends_what_waits(self):
        with Server("--scene", "mirror") as server:
            view = heliograph.connect(server.url)
            server.stop()
            with self.assertRaises(ConnectionError):
                view.scene.list()
            view.close()

    def test_a_token(self):
        with Server("--scene", "mirror", "--token", "a-token-of-the-library") as server:
            with heliograph.connect(server.url, token="a-token-of-the-library") as view:
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
        cls.server = Server("--scene", "hopping", scenes=scenes)

    @classmethod
    def tearDownClass(cls):
        super().tearDownClass()
        cls.folder.cleanup()

    def setUp(self):
        pass

    def run_example(self, name, *arguments):
        return subprocess.run(
            [sys.executable, os.path.join(PROTOCOL, "examples", name + ".py"), "--url",
             self.server.url, *arguments], cwd=self.folder.name, capture_output=True, text=True,
            env={**os.environ, "PYTHONPATH": LIBRARY}, timeout=60)

    def path(self, *parts):
        return os.path.join(self.folder.name, *parts)

    def picture(self, *parts):
        with open(self.path(*parts), "rb") as file:
            return decode_png(file.read())

    def test_turntable(self):
        arguments = ("--scene", "hopping", "--size", "64", "36", "--pictures", "4",
                     "--frames-each", "2", "--folder")
        for folder in ("turn", "again"):
            done = self.run_example("turntable", *arguments, folder)
            self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(sorted(os.listdir(self.path("turn"))),
                         ["000.png", "001.png", "002.png", "003.png"])
        pictures = [self.picture("turn", f"{i:03d}.png").rgb for i in range(4)]
        self.assertEqual(len(set(pictures)), 4)
        self.assertEqual(pictures, [self.picture("again", f"{i:03d}.png").rgb for i in range(4)])

    def test_thumbnails(self):
        done = self.run_example("thumbnails", "--models", "props", "--size", "48", "--samples",
                                "2", "--folder", "thumbs")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("props/broken", done.stderr)
        self.assertEqual(os.listdir(self.path("thumbs", "props")), ["mirror.png"])
        self.assertEqual(self.picture("thumbs", "props", "mirror.png").width, 48)

    def test_roughness_sweep(self):
        done = self.run_example("roughness_sweep", "--scene", "hopping", "--material", "metal_000",
                                "--steps", "3", "--size", "64", "36", "--samples", "2")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(done.stdout.count("roughness"), 3)
        root = xml.etree.ElementTree.parse(self.path("sweep.svg")).getroot()
        lines = root.findall("{http://www.w3.org/2000/svg}polyline")
        self.assertEqual([len(line.get("points").split()) for line in lines], [3, 3])

    def test_visual_regression(self):
        arguments = ("--scene", "hopping", "--size", "64", "36", "--frames", "2", "--folder",
                     "expected")
        done = self.run_example("visual_regression", *arguments, "--update")
        self.assertEqual(done.returncode, 0, done.stderr)
        done = self.run_example("visual_regression", *arguments)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        self.assertIn("same, 0.0000", done.stdout)
        kept = next(name for name in os.listdir(self.path("expected")) if name.endswith(".npy"))
        pixels = numpy.load(self.path("expected", kept))
        numpy.save(self.path("expected", kept), 255 - pixels)
        done = self.run_example("visual_regression", *arguments)
        self.assertEqual(done.returncode, 1, done.stdout + done.stderr)
        self.assertIn("DIFFERENT", done.stdout)
        self.assertTrue(os.path.exists(self.path("expected", kept[:-4] + ".actual.png")))
