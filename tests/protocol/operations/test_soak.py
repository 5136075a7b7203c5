"""The short form of soak.py."""

import os
import unittest

from harness.server import ServerTestCase
from soak import soak, soak_with_faults


class Soak(ServerTestCase):
    async def test_no_loss_no_reordering_no_leak(self):
        faults = await soak(self.server, 16, report=lambda line: None)
        self.assertEqual(faults, [])


@unittest.skipUnless(os.environ.get("HELIOGRAPH_FAULT_LIBRARY"), "HELIOGRAPH_FAULT_LIBRARY is not set")
class FaultySoak(unittest.IsolatedAsyncioTestCase):
    async def test_calls_that_fail_for_others_disturb_no_viewer(self):
        self.assertEqual(await soak_with_faults(16, report=lambda line: None), [])
