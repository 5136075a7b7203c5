"""protocol/examples/render_farm.py: a manifest over workers of dask.distributed, one of which is killed."""

import importlib.util
import json
import os
import signal
import subprocess
import sys
import tempfile
import time
import unittest

ROOT = os.path.normpath(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", ".."))
PROGRAM = os.path.join(ROOT, "protocol", "examples", "render_farm.py")


def children(pid):
    """The processes below one, with their command lines."""
    found = {}
    for name in filter(str.isdigit, os.listdir("/proc")):
        try:
            with open(f"/proc/{name}/stat", encoding="utf-8") as file:
                parent = int(file.read().rsplit(")", 1)[1].split()[1])
            with open(f"/proc/{name}/cmdline", "rb") as file:
                found[int(name)] = (parent, file.read().decode(errors="replace"))
        except (FileNotFoundError, ProcessLookupError):
            continue
    below, added = {pid}, True
    while added:
        added = {child for child, (parent, _) in found.items() if parent in below} - below
        below |= added
    return {child: found[child][1] for child in below - {pid} if child in found}


@unittest.skipUnless(importlib.util.find_spec("distributed"), "python3-distributed is not installed")
class RenderFarm(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name
        scene = os.path.join(os.environ["HELIOGRAPH_SCENES"], "mirror.glb")
        entries = [{"scene": scene, "output": f"{i}.png", "width": 128, "samples": 8} for i in range(8)]
        entries[5]["scene"] = "missing.glb"
        with open(os.path.join(folder.name, "jobs.json"), "w", encoding="utf-8") as file:
            json.dump(entries, file)

    def test_a_killed_worker_loses_nothing(self):
        environment = {**os.environ, "PYTHONPATH": os.path.join(ROOT, "protocol", "python")}
        with subprocess.Popen([sys.executable, PROGRAM, "jobs.json", "--workers", "2", "--threads", "1", "--shards", "4",
                               "--report", "report.json"], cwd=self.folder, env=environment, text=True,
                              stdout=subprocess.PIPE, stderr=subprocess.PIPE) as process:
            self.kill_a_worker(process)
            out, err = process.communicate(timeout=180)
        self.assertEqual(process.returncode, 3, err)
        self.assertIn("7 done, 1 failed", out)
        with open(os.path.join(self.folder, "report.json"), encoding="utf-8") as file:
            report = json.load(file)
        self.assertEqual([entry["state"] for entry in report["entries"]],
                         ["failed" if i == 5 else "done" for i in range(8)])
        images = sorted(name for name in os.listdir(self.folder) if name.endswith(".png"))
        self.assertEqual(images, [f"{i}.png" for i in range(8) if i != 5])

    def kill_a_worker(self, process):
        """The one whose renderer is seen first, with its renderer."""
        deadline = time.monotonic() + 60
        while time.monotonic() < deadline:
            for pid, command in children(process.pid).items():
                if "\0render\0" not in command or "taskset" in command:
                    continue
                with open(f"/proc/{pid}/stat", encoding="utf-8") as file:
                    worker = int(file.read().rsplit(")", 1)[1].split()[1])
                os.kill(worker, signal.SIGKILL)
                os.kill(pid, signal.SIGKILL)
                return
            time.sleep(0.02)
        self.fail("no renderer was started")


if __name__ == "__main__":
    unittest.main()
