"""Motion JPEG of a resting picture goes on, so that no proxy takes the stream for dead."""

import time

from harness.server import ServerTestCase
from test_video import Parts

LONGEST_SILENCE = 30  # seconds: the shortest of the usual limits of proxies


class PicturesAtRest(ServerTestCase):
    def test_the_last_picture_is_sent_again(self):
        self.server.call("settings.patch", {"patch": {"accumulation": {"max_samples": 1}}})
        parts = Parts(self.server, timeout=LONGEST_SILENCE)
        pauses, repeated = [], 0
        newest = None
        while repeated < 2:
            before = time.monotonic()
            picture = parts.picture().rgb
            pauses.append(time.monotonic() - before)
            repeated = repeated + 1 if picture == newest and pauses[-1] > 1 else 0
            newest = picture
        self.assertLess(max(pauses), LONGEST_SILENCE)
        parts.close()
