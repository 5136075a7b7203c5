"""Calls that fail: the short form of fault_sweep.py, and what happens at the start."""

import asyncio
import errno
import os
import subprocess
import tempfile
import unittest

import fault_sweep
from harness.faults import ALL_CALLS, OUT_OF_DEVICE_MEMORY, FaultTable, FaultyServer, rule
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
        self.assertEqual(sweep.wrong, [])
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


if __name__ == "__main__":
    unittest.main()
