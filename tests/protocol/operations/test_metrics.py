"""Metrics: the exact format, and correct values."""

import http.client
import re
import unittest

from harness.exposition import parse
from harness.server import Server, ServerTestCase
from harness.viewer import Viewer


class Metrics(ServerTestCase):
    def families(self):
        status, headers, page = self.server.get("/metrics")
        self.assertEqual(status, 200)
        self.assertEqual(headers["content-type"], "text/plain; version=0.0.4; charset=utf-8")
        return parse(page.decode())

    def value(self, name, suffix="", **labels):
        family = self.families()[name]
        return family.samples[suffix, tuple(sorted(labels.items()))]

    def test_the_format(self):
        families = self.families()
        for name in ("heliograph_build_info", "heliograph_ready", "heliograph_sessions",
                     "heliograph_viewers", "heliograph_frames_sent_total",
                     "heliograph_sent_bytes_total", "heliograph_frames_dropped_total",
                     "heliograph_frames_acknowledged_total", "heliograph_frames_pending",
                     "heliograph_ack_round_trip_seconds", "heliograph_render_seconds",
                     "heliograph_encode_seconds", "heliograph_pass_seconds",
                     "heliograph_scene_cache_hits_total", "heliograph_scene_cache_bytes",
                     "heliograph_radiance_cache_bytes",
                     "heliograph_connections", "heliograph_http_responses_total",
                     "heliograph_resident_memory_bytes", "process_cpu_seconds_total"):
            self.assertIn(name, families)
            self.assertGreater(len(families[name].help), 4)

    async def test_frames_and_acknowledgements_are_counted(self):
        def figures():
            families = self.families()
            return {name: families["heliograph_" + name].samples["", ()]
                    for name in ("frames_sent_total", "sent_bytes_total",
                                 "frames_acknowledged_total", "viewer_messages_total")}
        before = figures()
        async with Viewer(self.server) as viewer:
            await viewer.call("camera.set", {"eye": [3, 3, 3]})
            await viewer.rest()
            frames, size = viewer.frames_received, viewer.bytes_received
            self.server.wait_for(
                lambda: figures()["frames_acknowledged_total"]
                - before["frames_acknowledged_total"] == viewer.frames_received,
                "every frame's acknowledgement")
            self.assertEqual(self.value("heliograph_viewers"), 1)
            self.assertEqual(self.value("heliograph_frames_in_flight"), 0)
        after = figures()
        self.assertGreaterEqual(after["frames_sent_total"] - before["frames_sent_total"], frames)
        self.assertGreater(after["sent_bytes_total"] - before["sent_bytes_total"], 0.5 * size)
        self.assertGreaterEqual(
            after["viewer_messages_total"] - before["viewer_messages_total"], frames + 2)

    async def test_the_radiance_cache_has_cells_within_its_limit(self):
        async with Viewer(self.server) as viewer:
            await viewer.call("camera.set", {"eye": [3, 3, 3]})
            await viewer.rest()
        cells = self.value("heliograph_radiance_cache_cells")
        limit = self.value("heliograph_radiance_cache_cells_limit")
        self.assertGreater(cells, 0)
        self.assertLess(cells, limit)
        bytes_of_a_cell = self.value("heliograph_radiance_cache_bytes") / limit
        self.assertGreater(bytes_of_a_cell, 32)
        self.assertLess(bytes_of_a_cell, 256)

    async def test_histograms_fill(self):
        async with Viewer(self.server) as viewer:
            await viewer.call("camera.set", {"eye": [2, 2, 2]})
            await viewer.rest()
        families = self.families()
        frames = families["heliograph_render_seconds"].samples["_count", ()]
        self.assertGreater(frames, 0)
        passes = families["heliograph_pass_seconds"].samples
        counts = [value for (suffix, _), value in passes.items() if suffix == "_count"]
        self.assertGreater(len(counts), 3)
        self.assertLessEqual(max(counts), 2 * frames)
        total = sum(value for (suffix, _), value in passes.items() if suffix == "_sum")
        self.assertGreater(total, 0)
        self.assertLessEqual(total, families["heliograph_render_seconds"].samples["_sum", ()] * 3)
        self.assertGreater(families["heliograph_ack_round_trip_seconds"].samples["_count", ()], 0)

    def test_captures_are_counted(self):
        def figures():
            families = self.families()
            return (families["heliograph_capture_seconds"].samples["_count", ()],
                    families["heliograph_captures_failed_total"].samples["", ()])
        before = figures()
        self.server.call("frame.capture", {"samples": 1})
        self.server.get("/api/v1/sessions/main/frame.png?buffer=gbuffer.base_color")
        self.server.call("frame.step", {"frames": 0, "dt": 0.1})
        self.server.ask("frame.capture")
        self.server.call("frame.run")
        self.server.ask("frame.capture", {"buffer": "nothing"})
        self.server.get("/api/v1/sessions/main/frame.png?buffer=nothing")
        after = figures()
        self.assertEqual((after[0] - before[0], after[1] - before[1]), (2, 3))

    def test_responses_are_counted_by_status(self):
        def missing():
            samples = self.families()["heliograph_http_responses_total"].samples
            return samples.get(("", (("status", "404"),)), 0)
        before = missing()
        self.server.get("/nothing")
        self.assertEqual(missing(), before + 1)


class OwnPort(unittest.TestCase):
    def test_metrics_can_have_their_own_port(self):
        with Server("--metrics-listen", "127.0.0.1:0", "--token", "a-secret-of-tests") as server:
            line = server.process.stdout.readline()
            port = int(re.match(r"metrics at http://127\.0\.0\.1:(\d+)/metrics", line)[1])

            def ask(path, method="GET", **headers):
                connection = http.client.HTTPConnection("127.0.0.1", port, timeout=10)
                connection.request(method, path, headers=headers)
                response = connection.getresponse()
                return response.status, response.read()

            self.assertIn("heliograph_viewers", parse(ask("/metrics")[1].decode()))
            self.assertEqual(ask("/metrics", Host="prometheus-target:9464")[0], 200)
            self.assertEqual(ask("/health/live")[0], 200)
            self.assertEqual(ask("/health/ready")[0], 200)
            self.assertEqual(ask("/metrics", Origin="http://evil.example")[0], 403)
            for path in ("/", "/app.js", "/rpc", "/api/v1/schema", "/ws",
                         "/api/v1/sessions/main/frame.jpg"):
                self.assertEqual(ask(path)[0], 404, path)
            self.assertEqual(ask("/metrics", "POST")[0], 405)
            bearer = {"Authorization": "Bearer a-secret-of-tests"}
            self.assertEqual(server.get("/metrics", **bearer)[0], 404)
