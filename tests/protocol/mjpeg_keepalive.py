"""Motion JPEG of a static view repeats its last image, so that no proxy times out."""

import time

from harness.server import ServerTestCase
from test_video import Parts

LONGEST_SILENCE = 30  # seconds: the shortest of the usual limits of proxies


class MjpegKeepalive(ServerTestCase):
    def test_the_last_image_is_repeated_for_a_static_view(self):
        self.server.call("settings.patch", {"patch": {"accumulation": {"max_samples": 1}}})
        parts = Parts(self.server, timeout=LONGEST_SILENCE)
        pauses, repeated = [], 0
        newest = None
        while repeated < 2:
            before = time.monotonic()
            image = parts.image().rgb
            pauses.append(time.monotonic() - before)
            repeated = repeated + 1 if image == newest and pauses[-1] > 1 else 0
            newest = image
        self.assertLess(max(pauses), LONGEST_SILENCE)
        parts.close()
