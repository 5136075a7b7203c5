"""The short form of soak.py."""

from harness.server import ServerTestCase
from soak import soak


class Soak(ServerTestCase):
    async def test_nothing_is_lost_reordered_or_kept(self):
        faults = await soak(self.server, 16, report=lambda line: None)
        self.assertEqual(faults, [])
