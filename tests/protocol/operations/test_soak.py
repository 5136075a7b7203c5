"""The short form of soak.py."""

from harness.server import ServerTestCase
from soak import soak


class Soak(ServerTestCase):
    async def test_no_loss_no_reordering_no_leak(self):
        faults = await soak(self.server, 16, report=lambda line: None)
        self.assertEqual(faults, [])
