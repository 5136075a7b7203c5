"""Views of a session in notebooks: with ipywidgets, and without it."""

import os
import subprocess
import sys
import time
import unittest

from harness.images import decode_jpeg, decode_png
from harness.server import ServerTestCase

LIBRARY = os.path.normpath(os.path.join(os.path.dirname(__file__), "..", "..", "..", "protocol",
                                        "python"))
sys.path.insert(0, LIBRARY)

import heliograph  # noqa: E402
from heliograph.widget import LiveFrames  # noqa: E402

try:
    import ipywidgets
except ImportError:
    ipywidgets = None

WITHOUT_PACKAGES = """
import sys
sys.modules["ipywidgets"] = sys.modules["anywidget"] = None
import heliograph
with heliograph.connect(sys.argv[1]) as view:
    widget = view.widget()
    sys.stdout.buffer.write(widget._repr_png_())
    widget.close()
"""


def eventually(read, seconds=30):
    deadline = time.monotonic() + seconds
    while time.monotonic() < deadline:
        if read():
            return
        time.sleep(0.05)
    raise AssertionError("it did not happen in time")


class NotebookViews(ServerTestCase):
    def test_frames_arrive_and_messages_move_the_camera(self):
        frames = []
        with heliograph.connect(self.server.url) as view:
            live = LiveFrames(heliograph.connect(self.server.url), frames.append)
            try:
                eventually(lambda: frames)
                self.assertGreater(decode_jpeg(frames[0].data).width, 0)
                before, count = view.camera.get(), len(frames)
                live.receive({"kind": "orbit", "yaw": 30, "pitch": 0})
                turned = view.camera.get()
                self.assertNotEqual(turned["eye"], before["eye"])
                eventually(lambda: len(frames) > count)
                live.receive({"kind": "dolly", "factor": 0.5})
                self.assertNotEqual(view.camera.get()["eye"], turned["eye"])
                live.receive({"kind": "fit"})
                self.assertNotEqual(view.camera.get()["eye"], turned["eye"])
            finally:
                live.close()
            self.assertEqual(len(view.session.info()["viewers"]), 1, "the view has not left")

    @unittest.skipUnless(ipywidgets, "ipywidgets is not installed")
    def test_with_ipywidgets_the_image_follows_the_clients_calls(self):
        with heliograph.connect(self.server.url) as view:
            widget = view.widget()
            try:
                self.assertIsInstance(widget, ipywidgets.Image)
                eventually(lambda: len(widget.value) > 0)
                self.assertEqual(widget.value[:2], b"\xff\xd8")
                shown = widget.value
                view.camera.orbit(yaw=45)
                eventually(lambda: widget.value != shown)
            finally:
                widget.close()

    def test_without_packages_it_is_an_image(self):
        environment = {**os.environ, "PYTHONPATH": LIBRARY}
        run = subprocess.run([sys.executable, "-c", WITHOUT_PACKAGES, self.server.url],
                             env=environment, capture_output=True, timeout=120, check=False)
        self.assertEqual(run.returncode, 0, run.stderr.decode())
        self.assertGreater(decode_png(run.stdout).width, 0)


if __name__ == "__main__":
    unittest.main()
