"""HTTP: responses without body, persistent connections, streams beyond the limit of viewers, pages
of other origins, responses too large for a WebSocket."""

import asyncio
import json
import re
import socket
import struct
import threading
import time

from harness.exposition import parse
from harness.memory import compares_memory
from harness.raw_socket import TEXT, RawSocket, frame
from harness.server import TIME_FACTOR, ServerTestCase
from harness.viewer import Viewer

STREAM = "/api/v1/sessions/main/stream.mjpg"
IMAGE = "/api/v1/sessions/main/frame.png"


def responses(server, status):
    families = parse(server.get("/metrics")[2].decode())
    samples = families["heliograph_http_responses_total"].samples
    return samples.get(("", (("status", str(status)),)), 0)


class Answers(ServerTestCase):
    def exchange(self, raw, method, path):
        """Status, announced length and body, read as that method's answer has to be."""
        raw.send(f"{method} {path} HTTP/1.1\r\nHost: localhost\r\n\r\n".encode())
        head = raw.read_until(b"\r\n\r\n").decode()
        length = re.search(r"(?i)content-length: (\d+)", head)
        length = int(length[1]) if length else None
        return int(head.split()[1]), length, raw.read(length or 0) if method == "GET" else b""

    def test_head_has_the_headers_of_get_and_keeps_the_connection(self):
        for path, status in (("/", 200), ("/app.js", 200), (IMAGE, 200), ("/health/live", 200),
                             ("/nothing", 404), ("/rpc", 405), (IMAGE + "?samples=x", 400),
                             ("/api/v1/sessions/none/frame.png", 404)):
            with RawSocket(self.server) as raw:
                head = self.exchange(raw, "HEAD", path)
                get = self.exchange(raw, "GET", path)
                again = self.exchange(raw, "GET", "/health/live")
            self.assertEqual(head[:2], get[:2], path)
            self.assertEqual((get[0], len(get[2])), (status, get[1]), path)
            self.assertGreater(get[1], 0, path)
            self.assertEqual(again[2], b"live\n", path)

    def test_responses_without_body_have_no_content_length(self):
        tag = self.server.get("/app.js")[1]["etag"]
        _, headers, _ = self.server.get("/app.js", **{"If-None-Match": tag})
        self.assertNotIn("content-length", headers)

    def test_images_have_all_samples_unless_fewer_are_requested(self):
        self.server.call("settings.patch", {"patch": {"accumulation": {"max_samples": 9}}})
        for query, samples in (("", 9), ("?samples=9", 9), ("?samples=90", 9)):
            self.server.call("camera.orbit", {"yaw": 10})
            self.assertEqual(self.server.get(IMAGE + query)[1]["x-heliograph-samples"],
                             str(samples))
        self.server.call("camera.orbit", {"yaw": 10})
        few = int(self.server.get(IMAGE + "?samples=1")[1]["x-heliograph-samples"])
        self.assertLessEqual(few, 9)

    async def test_large_responses_do_not_disconnect_a_reading_client(self):
        self.server.call("stream.configure", {"width": 1280, "height": 720})
        params = {"buffer": "gbuffer.motion", "format": "npy", "samples": 1}

        async def batch(viewer, count):
            await viewer.send(json.dumps([{"jsonrpc": "2.0", "id": f"capture {i}",
                                           "method": "frame.capture", "params": params}
                                          for i in range(count)]))
            return await viewer.unasked.get()
        async with Viewer(self.server) as viewer:
            answers = await batch(viewer, 7)
            self.assertEqual([answer["id"] for answer in answers],
                             [f"capture {i}" for i in range(7)])
            self.assertGreater(sum(len(answer["result"]["data"]) for answer in answers), 128 << 20)
            # What would not fit is refused before it is made, each call by its name.
            answers = await batch(viewer, 30)
            self.assertEqual([answer["id"] for answer in answers],
                             [f"capture {i}" for i in range(30)])
            self.assertEqual(["result" in answer for answer in answers], [True] * 13 + [False] * 17)
            for answer in answers[13:]:
                self.assert_error(answer, -32013, limit="256 MiB")
                self.assertIn("HTTP", answer["error"]["message"])
            await viewer.call("camera.get")

    @compares_memory
    async def test_large_batches_take_no_more_memory_than_their_answer_may(self):
        self.server.call("stream.configure", {"width": 1920, "height": 1080})
        self.addCleanup(self.server.call, "stream.configure", {"width": 160, "height": 90})
        params = {"buffer": "gbuffer.motion", "format": "npy", "samples": 1}
        self.server.call("frame.capture", params)
        before = self.server.memory_bytes()
        peak = [before]
        answered = threading.Event()

        def measure():
            while not answered.wait(0.01):
                peak.append(self.server.memory_bytes())
        measuring = threading.Thread(target=measure)
        async with Viewer(self.server) as viewer:
            measuring.start()
            await viewer.send(json.dumps([{"jsonrpc": "2.0", "id": i, "method": "frame.capture",
                                           "params": params} for i in range(32)]))
            try:
                answers = await asyncio.wait_for(viewer.unasked.get(), 60 * TIME_FACTOR)
            finally:
                answered.set()
                measuring.join()
        self.assertEqual(sum("result" in answer for answer in answers), 6)
        # 32 answers would be 1.4 GB. One of 253 MiB exists in parts and joined for a moment.
        self.assertLess(max(peak) - before, 900 << 20)

    def test_many_responses_do_not_disconnect_a_reading_client(self):
        with RawSocket(self.server) as raw:
            raw.upgrade()
            self.ask(raw, 600)
            time.sleep(0.5)
            seen = 0
            while seen < 600:
                opcode, payload = raw.read_frame()
                self.assertIn(opcode, (1, 2), payload)
                seen += opcode == TEXT and b'"id":5' in payload[-200:] + payload[:200]

    def test_clients_that_do_not_read_responses_are_disconnected(self):
        def disconnected():
            page = self.server.get("/metrics")[2].decode()
            name = "heliograph_slow_viewers_disconnected_total"
            return int(re.search(rf"^{name} (\d+)", page, re.MULTILINE)[1])
        before = disconnected()
        with RawSocket(self.server) as raw:
            raw.upgrade()
            self.ask(raw, 900)
            self.server.wait_for(lambda: disconnected() == before + 1, "the timeout")

    def ask(self, raw, count):
        raw.send(frame(TEXT, b'{"jsonrpc":"2.0","id":5,"method":"settings.schema"}') * count)


class FewViewers(ServerTestCase):
    """Room for one viewer, and pages of another site may use it."""

    arguments = ("--max-viewers", "1", "--allow-origin", "https://good.example")
    good = {"Origin": "https://good.example"}

    def setUp(self):
        self.server.wait_for(lambda: b"heliograph_viewers 0\n" in self.server.get("/metrics")[2],
                             "room")

    async def test_a_stream_beyond_the_limit_gets_retry_after(self):
        before = responses(self.server, 503)
        async with Viewer(self.server):
            status, headers, body = self.server.get(STREAM)
        self.assertEqual(status, 503)
        self.assertEqual(int(headers["content-length"]), len(body))
        self.assertGreater(int(headers["retry-after"]), 0)
        self.assertIn(b"1 viewer", body)
        self.assertEqual(responses(self.server, 503), before + 1)

    def test_a_stream_counts_as_viewer_and_has_keepalive(self):
        before = responses(self.server, 200)
        with RawSocket(self.server) as raw:
            raw.send(f"GET {STREAM} HTTP/1.1\r\nHost: localhost\r\n\r\n".encode())
            raw.read_until(b"--frame\r\n")
            self.server.wait_for(lambda: self.asks_for(raw.socket), "the timer of keep-alive")
        # The two pages of metrics are counted as well, the second one after it was written.
        self.assertEqual(responses(self.server, 200), before + 2)

    def asks_for(self, client):
        """Whether the server's system has its keep-alive timer running for this connection."""
        def end(address):
            packed, = struct.unpack("=I", socket.inet_aton(address[0]))
            return f"{packed:08X}:{address[1]:04X}"
        wanted = [end(client.getpeername()), end(client.getsockname())]
        with open("/proc/net/tcp", encoding="ascii") as table:
            for line in table:
                fields = line.split()
                if fields[1:3] == wanted:
                    return fields[5].startswith("02:")
        raise AssertionError("no such connection")


    def test_embedding_by_other_origins_is_refused(self):
        for site in ("cross-site", "same-site"):
            for path in (STREAM, IMAGE + "?samples=65536", "/metrics", "/api/v1/schema"):
                status, _, _ = self.server.get(path, **{"Sec-Fetch-Site": site,
                                                        "Sec-Fetch-Mode": "no-cors"})
                self.assertEqual(status, 403, (site, path))
            navigation = {"Sec-Fetch-Site": site, "Sec-Fetch-Mode": "navigate"}
            self.assertEqual(self.server.get("/", **navigation)[0], 200)
            self.assertEqual(self.server.get(IMAGE, **navigation)[0], 403)
            self.assertEqual(self.server.get("/health/live", **navigation)[0], 200)
        for site in ("none", "same-origin"):
            self.assertEqual(self.server.get(IMAGE, **{"Sec-Fetch-Site": site})[0], 200)

    def assert_shared(self, headers):
        self.assertEqual(headers["access-control-allow-origin"], self.good["Origin"])
        self.assertEqual(headers["cross-origin-resource-policy"], "cross-origin")
        self.assertEqual(headers["vary"], "Origin")

    def test_cors_allows_listed_origins(self):
        status, headers, _ = self.server.get(IMAGE, **self.good,
                                             **{"Sec-Fetch-Site": "cross-site"})
        self.assertEqual(status, 200)
        self.assert_shared(headers)
        self.assertIn("X-Heliograph-Samples", headers["access-control-expose-headers"])
        body = json.dumps({"jsonrpc": "2.0", "id": 1, "method": "camera.get"}).encode()
        status, headers, answer = self.server.request("POST", "/rpc", body, self.good)
        self.assertEqual((status, json.loads(answer)["id"]), (200, 1))
        self.assert_shared(headers)
        self.assert_shared(self.server.get("/nothing", **self.good)[1])
        with RawSocket(self.server) as raw:
            raw.send(f"GET {STREAM} HTTP/1.1\r\nHost: localhost\r\n"
                     f"Origin: {self.good['Origin']}\r\n\r\n".encode())
            head = raw.read_until(b"\r\n\r\n").decode()
        self.assertIn(f"Access-Control-Allow-Origin: {self.good['Origin']}\r\n", head)
        self.assertIn("Cross-Origin-Resource-Policy: cross-origin\r\n", head)

    def test_cors_refuses_other_origins(self):
        for headers in ({}, {"Origin": "https://evil.example"}):
            _, answered, _ = self.server.get("/", **headers)
            self.assertNotIn("access-control-allow-origin", answered)
            self.assertEqual(answered["cross-origin-resource-policy"], "same-origin")
            self.assertEqual(answered["vary"], "Origin")

    def preflight(self, origin, **more):
        return self.server.request("OPTIONS", "/rpc", headers={
            "Origin": origin, "Access-Control-Request-Method": "POST",
            "Access-Control-Request-Headers": "authorization,content-type", **more})

    def test_cors_preflight_of_listed_origins(self):
        status, headers, body = self.preflight(
            self.good["Origin"], **{"Access-Control-Request-Private-Network": "true"})
        self.assertEqual((status, body), (204, b""))
        self.assert_shared(headers)
        for method in ("POST", "PUT", "DELETE"):
            self.assertIn(method, headers["access-control-allow-methods"].split(", "))
        self.assertIn("Authorization", headers["access-control-allow-headers"])
        self.assertEqual(headers["access-control-allow-private-network"], "true")
        status, headers, _ = self.preflight("https://evil.example")
        self.assertEqual(status, 403)
        self.assertNotIn("access-control-allow-methods", headers)
        self.assertEqual(self.server.request("OPTIONS", "/rpc")[0], 405)
