"""Limits: connections, slow senders, large headers, large or deep JSON, draining."""

import asyncio
import json
import signal
import socket
import time
import unittest

from harness.raw_socket import CLOSE, TEXT, RawSocket, frame
from harness.server import Server, ServerTestCase
from harness.viewer import Viewer


class Connections(ServerTestCase):
    arguments = ("--max-connections", "12", "--max-connections-per-client", "8",
                 "--metrics-listen", "127.0.0.1:0")

    def setUp(self):
        pass

    def connect(self, source="127.0.0.1"):
        raw = socket.socket()
        raw.settimeout(15)
        raw.bind((source, 0))
        raw.connect((self.server.host, self.server.port))
        return raw

    def answered(self, raw):
        try:
            raw.sendall(b"GET /health/live HTTP/1.1\r\nHost: localhost\r\n\r\n")
            return raw.recv(100).startswith(b"HTTP/1.1 200")
        except ConnectionError:
            return False

    def test_connections_are_limited_per_address_and_in_total(self):
        time.sleep(0.5)
        mine = [self.connect() for _ in range(10)]
        theirs = [self.connect("127.0.0.2") for _ in range(6)]
        try:
            self.assertEqual(sum(self.answered(raw) for raw in mine), 8)
            self.assertEqual(sum(self.answered(raw) for raw in theirs), 4)
        finally:
            for raw in (*mine, *theirs):
                raw.close()
        self.server.wait_for(lambda: self.server_answers(), "room again")

    def server_answers(self):
        try:
            return self.server.get("/health/live")[0] == 200
        except OSError:
            return False


class SlowSenders(ServerTestCase):
    """All at once, since each takes the ten seconds that the server waits."""

    def setUp(self):
        pass

    def test_slow_senders_time_out(self):
        own = f"Host: {self.server.host}:{self.server.port}\r\n"
        upgrade = (f"GET /ws HTTP/1.1\r\n{own}Upgrade: websocket\r\nConnection: Upgrade\r\n"
                   "Sec-WebSocket-Version: 13\r\n")
        call = f"POST /rpc HTTP/1.1\r\n{own}Content-Length: 1000\r\n\r\n"
        slow = {"nothing": "", "half a request line": "GET / HT",
                "half a head": f"GET / HTTP/1.1\r\n{own}", "half an upgrade": upgrade, "half a body": call + "{"}
        sockets = {}
        for name, begin in slow.items():
            sockets[name] = RawSocket(self.server, timeout=25)
            sockets[name].send(begin.encode())
        began = time.monotonic()
        while time.monotonic() - began < 8:
            for name, raw in sockets.items():
                if name != "nothing":
                    raw.send(b"A")
            time.sleep(1)
        for name, raw in sockets.items():
            with raw, self.subTest(name):
                try:
                    while raw.socket.recv(65536):
                        pass
                except ConnectionResetError:
                    pass
                self.assertLess(time.monotonic() - began, 20)
        self.assertEqual(self.server.get("/health/live")[0], 200)


class Sizes(ServerTestCase):
    def setUp(self):
        pass

    def test_http_headers_are_limited(self):
        for path, headers in (("/" + "x" * 9000, {}), ("/", {"X-Long": "y" * 9000}),
                              ("/", {f"X-{i}": "z" * 100 for i in range(100)})):
            self.assertEqual(self.server.get(path, **headers)[0], 413)
        self.assertEqual(self.server.get("/", **{"X-Fine": "y" * 6000})[0], 200)

    def test_json_size_and_depth_are_limited(self):
        for text, code in (("[" * 40000, -32013), ('{"a":' * 10000, -32013),
                           ("[" * 65 + "]" * 65, -32013), ("[1," * 60, -32700),
                           ('"' + "x" * 60000, -32700), ("1e999999", -32700),
                           ('{"jsonrpc":"2.0","id":' + "9" * 400 + ',"method":"x"}', -32700),
                           ('{"jsonrpc":"2.0","id":1,"method":"' + "m" * 5000 + '"}', -32601),
                           ("[" + ",".join(["1"] * 33) + "]", -32013), ("\x00" * 100, -32700)):
            status, answer = self.server.post_rpc(text.encode())
            self.assertEqual(status, 200)
            if isinstance(answer, list):
                answer = answer[0]
            self.assertEqual(answer["error"]["code"], code, text[:40])
            self.assertLess(len(json.dumps(answer)), 12000)
        self.assertEqual(self.server.request("POST", "/rpc", b" " * 70000)[0], 413)

    def test_the_websocket_has_the_same_limits(self):
        for text, code in ((b"[" * 40000, -32013), (b'{"a":' * 10000, -32013)):
            with RawSocket(self.server) as raw:
                raw.upgrade()
                raw.send(frame(TEXT, text))
                opcode, payload = raw.read_frame()
                self.assertEqual((opcode, json.loads(payload)["error"]["code"]), (TEXT, code))

    def test_scene_names_cannot_leave_the_catalogue(self):
        for name in ("../../etc/passwd", "/etc/passwd", "..\\..\\x", "%2e%2e/secret", "mirror/../x",
                     "file:///etc/passwd", "http://evil.example/x.glb", "mirror\u0000.glb", "~",
                     "mirror.glb/", "./mirror", "//mirror", "\u202emirror", "x" * 500):
            answer = self.server.ask("scene.load", {"name": name})
            self.assert_error(answer, -32004)
            self.assertLess(len(json.dumps(answer)), 2000)
            self.assertNotIn("/etc/", answer["error"]["message"])


class Draining(unittest.IsolatedAsyncioTestCase):
    async def test_readiness_fails_first_and_new_viewers_are_refused(self):
        with await asyncio.to_thread(Server, "--drain-notice", "3", "--drain-deadline", "4"
                                     ) as server:
            async with Viewer(server) as viewer:
                self.assertEqual(server.get("/health/ready")[0], 200)
                begin = time.monotonic()
                server.process.send_signal(signal.SIGTERM)
                server.wait_for(lambda: server.get("/health/ready")[0] == 503, "the notice")
                headers = server.get("/health/ready")[1]
                self.assertGreater(int(headers["retry-after"]), 0)
                self.assertEqual(server.get("/health/live")[0], 200)
                for path in ("/", "/metrics"):
                    status, headers, _ = server.get(path)
                    self.assertEqual(status, 503, path)
                    self.assertIn("retry-after", headers)
                with RawSocket(server) as raw:
                    status, text = raw.upgrade()
                    self.assertEqual(status, 503)
                    self.assertIn("retry-after", text.lower())
                await viewer.call("camera.set", {"eye": [2, 2, 2]})
                await viewer.next_frame()
                code, reason = await viewer.closed()
                self.assertGreater(time.monotonic() - begin, 2.5)
                self.assertEqual(code, 1001)
                self.assertGreater(json.loads(reason)["reconnect_after_ms"], 0)
            self.assertEqual(await asyncio.to_thread(server.wait), 0)
            self.assertLess(time.monotonic() - begin, 9)

    async def test_a_second_signal_ends_it_at_once(self):
        with await asyncio.to_thread(Server, "--drain-notice", "60") as server:
            server.process.send_signal(signal.SIGTERM)
            server.wait_for(lambda: "shutting down after" in server.log_text(), "the first signal")
            self.assertTrue(server.alive)
            begin = time.monotonic()
            self.assertNotEqual(await asyncio.to_thread(server.stop), 0)
            self.assertLess(time.monotonic() - begin, 2)

    async def test_unanswered_close_handshakes_end_at_the_deadline(self):
        with await asyncio.to_thread(Server, "--drain-deadline", "1") as server:
            with RawSocket(server) as raw:
                raw.upgrade()
                raw.send(frame(TEXT, b'{"jsonrpc":"2.0","id":1,"method":"hello"}'))
                raw.read_frame()
                begin = time.monotonic()
                server.process.send_signal(signal.SIGTERM)
                while True:
                    opcode, payload = raw.read_frame()
                    if opcode == CLOSE:
                        break
                self.assertEqual(int.from_bytes(payload[:2], "big"), 1001)
                self.assertEqual(await asyncio.to_thread(server.wait), 0)
                self.assertLess(time.monotonic() - begin, 4)
