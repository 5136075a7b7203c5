"""The short form of load.py, and what it counts with."""

import math
import unittest

from harness.load_measures import Input, Latency, latencies_of, percentile, recovered_after
from harness.load_socket import FrameNote
from harness.server import ServerTestCase
from load import SHORT, Load


class Measures(unittest.TestCase):
    def test_latencies_count_from_when_inputs_were_due(self):
        frames = [FrameNote(at, rev, 1.0, 0) for at, rev in ((1.0, 1), (5.0, 4))]
        inputs = [Input(1.5, 2), Input(2.0, 3), Input(2.5, 4), Input(3.0, 5), Input(3.5, None)]
        self.assertEqual(latencies_of(inputs, frames, end=6.0), [
            Latency(1.5, 3.5), Latency(2.0, 3.0), Latency(2.5, 2.5),
            Latency(3.0, 3.0, shown=False), Latency(3.5, 2.5, shown=False)])

    def test_percentiles_are_values_that_occurred(self):
        values = [float(i) for i in range(1000, 0, -1)]
        self.assertEqual([percentile(values, share) for share in (0.5, 0.99, 0.999, 1.0)],
                         [500.0, 990.0, 999.0, 1000.0])
        self.assertEqual(percentile([7.0], 0.5), 7.0)

    def test_recovery_ends_with_the_first_of_some_normal_latencies_in_a_row(self):
        latencies = [Latency(due, seconds) for due, seconds in
                     ((9, 0.1), (10, 3), (11, 0.1), (12, 2), (13, 0.1), (14, 0.2), (15, 0.1))]
        self.assertAlmostEqual(recovered_after(latencies, 10, normal=0.2, row=3), 3.1)
        self.assertEqual(recovered_after(latencies, 10, normal=0.2, row=4), math.inf)


class Loaded(ServerTestCase):
    arguments = SHORT.arguments()

    async def test_viewers_keep_their_latency_and_what_is_too_much_is_refused_at_once(self):
        self.assertEqual(await Load(self.server, SHORT, report=lambda line: None).run(), [])
