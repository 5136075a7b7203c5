"""Start, monitoring and shutdown of the server; the other commands of the program."""

import asyncio
import json
import os
import re
import shutil
import signal
import socket
import subprocess
import tempfile
import time
import unittest

from harness.images import decode_jpeg, decode_png
from harness.server import Server, ServerTestCase
from harness.viewer import Viewer


def run(*arguments, environment=None, timeout=120):
    """The program with these arguments: exit code, stdout, stderr."""
    done = subprocess.run([os.environ["HELIOGRAPH_BINARY"], *arguments], capture_output=True,
                          text=True, timeout=timeout, env={**os.environ, **(environment or {})},
                          check=False)
    return done.returncode, done.stdout, done.stderr


def scene_file(name):
    return os.path.join(os.environ["HELIOGRAPH_SCENES"], name)


class Monitoring(ServerTestCase):
    def test_health(self):
        for path in ("/health/live", "/health/ready"):
            self.assertEqual(self.server.get(path)[0], 200)
        for url in (self.server.url + "health/ready", self.server.url, self.server.url.rstrip("/")):
            code, out, _ = run("health", "--url", url)
            self.assertEqual((code, "200 ready" in out), (0, True), url)

    async def test_metrics_count(self):
        def value(name):
            page = self.server.get("/metrics")[2].decode()
            return float(re.search(rf"^heliograph_{name} (\S+)$", page, re.MULTILINE)[1])
        page = self.server.get("/metrics")[2]
        before = value("frames_sent_total"), value("render_seconds_count")
        async with Viewer(self.server) as viewer:
            self.assertEqual(value("viewers"), 1)
            await viewer.call("camera.set", {"eye": [3, 3, 3]})
            await viewer.rest()
            received, rendered = viewer.frames_received, value("render_seconds_count")
        self.assertGreaterEqual(rendered - before[1], 4)
        self.assertEqual(value("frames_sent_total") - before[0], received)
        self.assertGreater(value("sent_bytes_total"), 64 * received)
        self.assertGreater(value("resident_memory_bytes"), 1e6)
        self.assertIn(b'heliograph_pass_milliseconds{pass="', page)

    def test_images_over_http(self):
        status, headers, body = self.server.get("/api/v1/sessions/main/frame.jpg?samples=2")
        self.assertEqual((status, headers["content-type"]), (200, "image/jpeg"))
        self.assertEqual(decode_jpeg(body).width, 160)
        status, headers, body = self.server.get("/api/v1/sessions/main/frame.png?buffer=output")
        self.assertEqual((status, headers["content-type"]), (200, "image/png"))
        self.assertEqual(decode_png(body).height, 90)
        for path, expected in (("main/frame.bmp", 404), ("other/frame.png", 404),
                               ("main/frame.png?buffer=none", 400),
                               ("main/frame.png?samples=x", 400),
                               ("main/frame.png?samples=-1", 400)):
            self.assertEqual(self.server.get("/api/v1/sessions/" + path)[0], expected, path)
        for samples in ("0", "65537", "99999999999", "1.5"):
            status, _, body = self.server.get(
                "/api/v1/sessions/main/frame.png?samples=" + samples)
            self.assertEqual((status, body),
                             (400, b"samples: must be an integer from 1 to 65536\n"))


class Shutdown(unittest.IsolatedAsyncioTestCase):
    async def test_viewers_are_told_to_reconnect(self):
        for number in (signal.SIGTERM, signal.SIGINT):
            with await asyncio.to_thread(Server) as server:
                async with Viewer(server) as viewer:
                    await viewer.next_frame()
                    begin = time.monotonic()
                    server.process.send_signal(number)
                    code, reason = await viewer.closed()
                self.assertEqual(code, 1001)
                self.assertGreater(json.loads(reason)["reconnect_after_ms"], 0)
                self.assertEqual(await asyncio.to_thread(server.wait), 0)
                self.assertLess(time.monotonic() - begin, 6)

    async def test_a_viewer_that_does_not_read_does_not_delay_shutdown(self):
        with await asyncio.to_thread(Server, "--set", "accumulation.max_samples=60000") as server:
            viewer = Viewer(server)
            await viewer.__aenter__()
            viewer.socket.transport.pause_reading()
            await asyncio.sleep(1)
            begin = time.monotonic()
            self.assertEqual(await asyncio.to_thread(server.stop), 0)
            self.assertLess(time.monotonic() - begin, 8)
            viewer.socket.transport.abort()


    async def test_pending_work_does_not_delay_shutdown(self):
        with await asyncio.to_thread(Server, "--set", "accumulation.max_samples=60000") as server:
            async with Viewer(server) as viewer:
                waiting = asyncio.create_task(viewer.ask("frame.capture"))
                over_http = asyncio.create_task(asyncio.to_thread(self.capture, server))
                loading = asyncio.create_task(viewer.ask("scene.load", {"name": "furnace"}))
                await asyncio.sleep(0.3)
                self.assertFalse(waiting.done() or over_http.done())
                self.assertEqual(await asyncio.to_thread(server.stop), 0)
                await asyncio.wait([waiting, over_http, loading], timeout=10)
                self.assertEqual((await viewer.closed())[0], 1001)

    @staticmethod
    def capture(server):
        try:
            server.ask("frame.capture")
        except OSError:
            pass  # the server has already exited


class CommandLine(unittest.TestCase):
    def fails(self, *arguments, saying, environment=None):
        code, out, err = run(*arguments, environment=environment)
        self.assertNotEqual(code, 0, out)
        lines = [line for line in err.splitlines() if line.startswith("heliograph: ")]
        self.assertEqual(len(lines), 1, err)
        self.assertRegex(lines[0], saying)

    def test_help_has_examples(self):
        for command in ((), ("serve",), ("render",), ("devices",), ("schema",), ("health",)):
            code, out, _ = run(*command, "--help")
            self.assertEqual(code, 0)
            self.assertIn("Example", out, command)

    def test_mistyped_arguments_get_a_suggestion(self):
        self.fails("serv", saying="unknown command serv; did you mean serve")
        self.fails("rendr", "a.glb", "-o", "a.png", saying="unknown command rendr; did you mean render")
        self.fails("serve", "--prot", "1", saying="unknown option --prot; did you mean --port")
        self.fails("--verson", saying="unknown option --verson; did you mean --version")
        self.fails(saying="a command is missing: serve, render")
        self.fails("devices", "llvmpipe", saying="unexpected argument llvmpipe")
        self.fails("serve", "--tracer", "embre", saying="not one of auto,.*; did you mean embree")
        self.fails("serve", "--set", "tone_map.curv=agx", saying="did you mean tone_map.curve")
        self.fails("serve", "--set", "exposure.compensation=99", saying="16")
        self.fails("serve", "--scene", "mirorr", "--scene-root", os.environ["HELIOGRAPH_SCENES"],
                   saying="did you mean mirror")

    def test_failed_starts_report_the_reason(self):
        root = ("--scene-root", os.environ["HELIOGRAPH_SCENES"])
        with tempfile.TemporaryDirectory() as empty:
            self.fails("serve", "--scene-root", empty + "/missing", saying="is not a folder")
            with open(empty + "/broken.glb", "wb") as file:
                file.write(b"nonsense")
            self.fails("serve", "--scene-root", empty, "--port", "0",
                       saying="heliograph: broken: cannot be loaded: not a glTF file")
        with tempfile.NamedTemporaryFile(suffix=".hdr") as file:
            self.fails("serve", "--port", "0", *root, "--environment", file.name,
                       saying="the environment " + os.path.basename(file.name) + " is not")
        self.fails("serve", "--host", "0.0.0.0", *root, saying="--token")
        self.fails("serve", "--host", "0.0.0.0", "--token", "short", *root, saying="8 characters")
        self.fails("serve", "--port", "0", *root, saying="device", environment={
            "HELIOGRAPH_DEVICE": "no such device"})
        self.fails("serve", "--set", "view.buffer=nothing", *root, saying="view.buffer")
        self.fails("serve", "--scene", scene_file("mirror.glb") + "x", *root, saying="catalogue")
        with tempfile.NamedTemporaryFile(suffix=".glb") as file:
            self.fails("serve", "--scene", file.name, *root, saying="--scene-root")
        with socket.socket() as taken:
            taken.bind(("127.0.0.1", 0))
            taken.listen()
            port = str(taken.getsockname()[1])
            begin = time.monotonic()
            self.fails("serve", "--port", port, *root, saying="listen on")
            self.assertLess(time.monotonic() - begin, 2, "it was told after the set-up")
            self.fails("serve", "--port", "0", "--metrics-listen", "127.0.0.1:" + port, *root,
                       saying="listen on")

    def test_a_server_without_scenes_starts_and_takes_them_later(self):
        with tempfile.TemporaryDirectory() as folder:
            with Server(scenes=folder) as server:
                self.assertEqual(server.get("/health/ready")[0], 200)
                self.assertIn("no scene found: put .glb or .gltf files into " + folder,
                              server.log_text())
                self.assertEqual(server.call("scene.list"), {"scenes": [], "current": None})
                self.assertEqual(server.ask("camera.get")["error"]["code"], -32050)
                shutil.copy(scene_file("mirror.glb"), folder)
                server.call("scene.load", {"name": "mirror"})
                status, _, body = server.get("/api/v1/sessions/main/frame.png?samples=1")
                self.assertEqual(status, 200)
                self.assertGreater(decode_png(body).deviation(), 5)

    def test_options_from_environment_and_file(self):
        with tempfile.NamedTemporaryFile("w", suffix=".toml") as config:
            config.write('[serve]\nset = ["exposure.compensation=3"]\nwidth = 99\n')
            config.flush()
            with Server("--config", config.name, environment={"HELIOGRAPH_LOG_FORMAT": "json"}
                        ) as server:
                stream = server.call("stream.configure", {})
                self.assertEqual(stream["width"], 160, "the command line comes first")
                server.stop()
                for line in server.log_text().splitlines():
                    self.assertIn("message", json.loads(line))

    def test_schema(self):
        code, out, _ = run("schema")
        document = json.loads(out)
        self.assertEqual((code, sorted(document)), (0, ["openrpc", "settings"]))
        code, out, _ = run("schema", "--markdown")
        self.assertIn("tone_map.curve", out)

    def test_devices(self):
        code, out, _ = run("devices")
        self.assertEqual(code, 0)
        self.assertIn("Vulkan", out)

    def test_health_without_a_server_fails(self):
        with socket.socket() as unused:
            unused.bind(("127.0.0.1", 0))
            port = unused.getsockname()[1]
        code, _, err = run("health", "--url", f"http://127.0.0.1:{port}/health/ready")
        self.assertEqual(code, 1)
        self.assertIn("refused", err)

    def test_health_queries_the_configured_address(self):
        with socket.socket() as unused:
            unused.bind(("127.0.0.1", 0))
            port = unused.getsockname()[1]
            for host, asked in (("127.0.0.1", "127.0.0.1"), ("0.0.0.0", "127.0.0.1"),
                                ("::", "[::1]"), ("127.0.0.2", "127.0.0.2")):
                code, _, err = run("health", environment={"HELIOGRAPH_HOST": host,
                                                          "HELIOGRAPH_PORT": str(port)})
                self.assertEqual(code, 1)
                self.assertIn(f"http://{asked}:{port}/health/ready: ", err)
        code, _, err = run("health", environment={"HELIOGRAPH_HEALTH_URL": "http://127.0.0.1:1/a",
                                                  "HELIOGRAPH_PORT": str(port)})
        self.assertEqual(code, 1)
        self.assertIn("http://127.0.0.1:1/a: ", err)
        code, _, err = run("health", environment={"HELIOGRAPH_PORT": "0"})
        self.assertEqual(code, 1)
        self.assertIn("--url", err)

    def test_render_writes_an_image(self):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "out.png")
            code, out, err = run("render", scene_file("mirror.glb"), "-o", path, "--width", "96",
                                 "--height", "64", "--samples", "2", "--timings", "--frames", "2")
            self.assertEqual(code, 0, err)
            timings = json.loads(out)
            self.assertEqual(timings["frames"], 2)
            self.assertGreaterEqual(len(timings["passes"]), 3)
            with open(path, "rb") as file:
                image = decode_png(file.read())
            self.assertEqual((image.width, image.height), (96, 64))
            self.assertGreater(image.deviation(), 5)

    def test_render_reports_errors(self):
        with tempfile.TemporaryDirectory() as folder:
            out = ("-o", folder + "/out.png")
            self.fails("render", folder + "/missing.glb", *out, saying="missing.glb|not exist")
            self.fails("render", scene_file("mirror.glb"), saying="--output")
            small = ("--width", "32", "--height", "32", "--samples", "1")
            self.fails("render", scene_file("mirror.glb"), *out, *small, "--buffer", "outptu",
                       saying="outptu|output")
            self.fails("render", scene_file("mirror.glb"), *out, *small, "--camera", "nowhere",
                       saying="camera")
