"""Calls that fail: the short form of fault_sweep.py, and what happens at the start."""

import asyncio
import base64
import errno
import os
import signal
import subprocess
import tempfile
import unittest

import fault_sweep
from harness.faults import ALL_CALLS, OUT_OF_DEVICE_MEMORY, FaultTable, FaultyServer, rule
from harness.gltf import document, write_glb
from harness.viewer import Viewer


def start(*rules):
    """Starts a server that ends at once, because a call fails; exit code and lines of the program."""
    table = FaultTable()
    process = subprocess.run(
        [os.environ["HELIOGRAPH_BINARY"], "serve", "--port", "0", "--scene-root",
         os.environ["HELIOGRAPH_SCENES"]], capture_output=True, text=True, timeout=60,
        env={**os.environ, **table.environment, "HELIOGRAPH_TEST_FAULTS": " ".join(rules)})
    table.close()
    return process.returncode, [line for line in process.stderr.splitlines()
                                if line.startswith("heliograph: ")]


class Sweep(unittest.TestCase):
    def test_the_server_outlives_calls_that_fail(self):
        sweep = asyncio.run(fault_sweep.run(4, ["short"], report=lambda line: None))
        self.assertFalse(sweep.wrong, "\n".join(sweep.wrong))
        self.assertGreater(sum(sweep.injected.values()), 15)


class Start(unittest.TestCase):
    """A server that cannot start ends with one sentence."""

    def assert_ends(self, code, lines):
        self.assertEqual((code, len(lines)), (1, 1), lines)

    def test_without_threads(self):
        code, lines = start(rule("pthread_create", 2, errno.EAGAIN))
        self.assert_ends(code, lines)
        self.assertIn("unavailable", lines[0])

    def test_without_device_memory(self):
        code, lines = start(rule("vkAllocateMemory", 1, OUT_OF_DEVICE_MEMORY))
        self.assert_ends(code, lines)
        self.assertIn("memory", lines[0])

    def test_without_memory(self):
        self.assert_ends(*start(rule("operator_new", 2000, errno.ENOMEM)))


class Requests(unittest.TestCase):
    def test_a_step_after_one_that_failed_is_rendered(self):
        with FaultyServer() as server:
            server.call("frame.step", {"frames": 1, "dt": 0})
            server.call("settings.patch", {"patch": {"indirect": {"enabled": False}}})
            server.faults.arm("vkCreateImage", 1, OUT_OF_DEVICE_MEMORY)
            failed = server.ask("frame.step", {"frames": 1, "dt": 0})
            self.assertEqual(server.faults.disarm("vkCreateImage")[1], 1)
            self.assertEqual(failed["error"]["code"], -32603)
            self.assertEqual(server.call("frame.step", {"frames": 1, "dt": 0})["lockstep"], True)

    def test_an_upload_is_told_that_the_disk_is_full(self):
        with open(os.path.join(os.environ["HELIOGRAPH_SCENES"], "mirror.glb"), "rb") as file:
            scene = file.read()
        with tempfile.TemporaryDirectory() as folder, \
                FaultyServer("--uploads", folder) as server:
            server.faults.arm("write", 2, errno.ENOSPC, only="incoming")
            status, _, answer = server.request("PUT", "/api/v1/scenes/full", scene)
            self.assertEqual(server.faults.disarm("write")[1], 1)
            self.assertEqual(status, 503)
            self.assertIn(b"disk", answer)
            self.assertEqual(os.listdir(os.path.join(folder, "incoming")), [])
            self.assertEqual(server.request("PUT", "/api/v1/scenes/full", scene)[0], 201)

    def test_the_end_of_a_job_is_recorded_once_the_disk_has_room(self):
        entry = {"scene": "mirror", "width": 16, "height": 16, "samples": 1}
        with tempfile.TemporaryDirectory() as folder, FaultyServer("--jobs", folder) as server:
            job = server.call("job.create", {"entries": [entry]})["job"]
            server.wait_for(lambda: self.state(server, job) == "running", "the start", timeout=60)
            server.faults.arm("pwrite", 1, errno.ENOSPC, times=ALL_CALLS, only="jobs.sqlite")
            server.wait_for(lambda: "disk is full" in server.log_text(), "the fault", timeout=120)
            server.faults.disarm("pwrite")
            server.wait_for(lambda: self.state(server, job) in ("done", "failed"), "the end",
                            timeout=120)

    def state(self, server, job):
        return server.call("job.status", {"job": job})["state"]


class Connections(unittest.TestCase):
    def test_a_viewer_whose_answer_cannot_be_sent_is_disconnected(self):
        asyncio.run(self.lose_an_answer())

    async def lose_an_answer(self):
        with FaultyServer() as server:
            async with Viewer(server) as viewer:
                await viewer.rest()
                await viewer.call("stream.pause")
                server.faults.arm("sendmsg", 1, errno.EPIPE)
                asking = asyncio.create_task(viewer.ask("camera.get"))
                await viewer.closed(5)
                self.assertEqual(server.faults.disarm("sendmsg")[1], 1)
                with self.assertRaises(asyncio.CancelledError):
                    await asking


class Clock(unittest.TestCase):
    def test_jumps_by_a_day_disturb_no_session(self):
        with FaultyServer() as server:
            for seconds in (86400, -86400):
                server.faults.arm("clock_gettime", 1, amount=seconds, times=ALL_CALLS)
                server.call("session.create", {"name": f"after{seconds}"})
                self.assertGreaterEqual(server.call("frame.capture", {"samples": 1})["samples"], 1)
                self.assertEqual(server.get("/health/ready")[0], 200)
                self.assertGreater(server.faults.disarm("clock_gettime")[1], 0)


def scene_with_jpeg(folder):
    """A triangle with a texture, of which nothing but the decoder is to be called."""
    content, binary = document([0, 0, 0, 1, 0, 0, 0, 1, 0], [0, 1, 2])
    jpeg = base64.b64encode(b"\xff\xd8\xff\xe0" + bytes(60)).decode()
    content.update(images=[{"uri": "data:image/jpeg;base64," + jpeg}], textures=[{"source": 0}],
                   materials=[{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}])
    content["meshes"][0]["primitives"][0]["material"] = 0
    path = os.path.join(folder, "scene.glb")
    write_glb(path, content, binary)
    with open(path, "rb") as file:
        return file.read()


class Imports(unittest.TestCase):
    """A decoder that fails costs the upload that it decodes, and its process."""

    @classmethod
    def setUpClass(cls):
        cls.folder = cls.enterClassContext(tempfile.TemporaryDirectory())
        cls.scene = scene_with_jpeg(cls.folder)
        # Memory of imports is the sum of these.
        limits = ("--max-scene-bytes", "100000000", "--max-unpacked-bytes", "1000000",
                  "--max-geometry-bytes", "100000000", "--max-texels", "10000000")
        cls.server = cls.enterClassContext(FaultyServer(
            "--uploads", os.path.join(cls.folder, "uploads"), "--max-import-seconds", "1", *limits))

    def put(self):
        status, _, answer = self.server.request("PUT", "/api/v1/scenes/odd", self.scene)
        return status, answer.decode()

    def put_where_the_decoder_fails(self, error):
        with self.server.faults.fault("decoder", 1, error) as counts:
            answer = self.put()
        self.assertEqual(counts[1], 1)
        self.assertEqual(self.put()[0], 201, "the next upload is imported")
        return answer

    def test_a_crash(self):
        self.assertEqual(self.put_where_the_decoder_fails(signal.SIGSEGV),
                         (400, "body: cannot be loaded: a decoder failed (signal 11)\n"))

    def test_a_call_of_the_system(self):
        status, answer = self.put_where_the_decoder_fails(signal.SIGSYS)
        self.assertEqual(status, 400)
        self.assertIn("called the system", answer)

    def test_a_loop(self):
        status, answer = self.put_where_the_decoder_fails(signal.SIGXCPU)
        self.assertEqual((status, "longer than 1 s" in answer), (400, True), answer)

    def test_memory_without_end(self):
        self.assertEqual(self.put_where_the_decoder_fails(errno.ENOMEM)[0], 400)

    def test_a_kernel_that_restricts_no_calls_is_told_of_once(self):
        with self.server.faults.fault("prctl", 1, errno.EPERM, times=2) as counts:
            self.assertEqual([self.put()[0], self.put()[0]], [201, 201])
        self.assertEqual(counts[1], 2)
        self.assertEqual(self.server.log_text().count("not restricted: Operation not permitted"), 1)

    def test_a_helper_that_was_killed_is_started_again(self):
        self.assertEqual(self.put()[0], 201)
        for task in os.listdir(f"/proc/{self.server.process.pid}/task"):
            children = f"/proc/{self.server.process.pid}/task/{task}/children"
            with open(children, encoding="ascii") as file:
                for child in file.read().split():
                    os.kill(int(child), signal.SIGKILL)
        self.assertEqual(self.put()[0], 201)


if __name__ == "__main__":
    unittest.main()
