"""WebSocket and HTTP as no library would send them. Whatever comes, the server lives and other
viewers do not notice."""

import json
import os
import random
import struct
import time

from harness.memory import assert_less_memory
from harness.raw_socket import BINARY, CLOSE, PING, PONG, TEXT, RawSocket, frame
from harness.server import ServerTestCase
from harness.viewer import Viewer

CALL = json.dumps({"jsonrpc": "2.0", "id": 5, "method": "camera.get"}).encode()


class Framing(ServerTestCase):
    def setUp(self):
        pass

    def exchange(self, *data):
        """Sends bytes after the upgrade; returns the close code."""
        with RawSocket(self.server) as raw:
            self.assertEqual(raw.upgrade()[0], 101)
            for piece in data:
                raw.send(piece)
            return raw.close_code()

    def answer(self, *data):
        """Sends bytes after the upgrade; returns the first text that comes back."""
        with RawSocket(self.server) as raw:
            self.assertEqual(raw.upgrade()[0], 101)
            for piece in data:
                raw.send(piece)
            while True:
                opcode, payload = raw.read_frame()
                if opcode == TEXT:
                    return json.loads(payload)
                self.assertNotEqual(opcode, CLOSE, payload)

    def test_payload_lengths_at_encoding_boundaries(self):
        for size in (len(CALL), 125, 126, 127, 65534, 65535, 65536):
            padded = CALL + b" " * (size - len(CALL))
            self.assertIn("result", self.answer(frame(TEXT, padded)), size)

    def test_a_message_over_the_limit(self):
        self.assertEqual(self.exchange(frame(TEXT, b" " * 65537)), 1009)
        self.assertEqual(self.exchange(frame(TEXT, b"", length=1 << 40)), 1009)

    def test_fragments_with_a_ping_between(self):
        with RawSocket(self.server) as raw:
            raw.upgrade()
            raw.send(frame(TEXT, CALL[:10], fin=False) + frame(PING, b"hello")
                     + frame(0, CALL[10:20], fin=False) + frame(0, CALL[20:]))
            self.assertEqual(raw.read_frame(), (PONG, b"hello"))
            opcode, payload = raw.read_frame()
            self.assertEqual(opcode, TEXT)
            self.assertIn("result", json.loads(payload))

    def test_endless_fragments_are_stopped_at_the_limit(self):
        pieces = [frame(TEXT, b" " * 8000, fin=False)] + [frame(0, b" " * 8000, fin=False)] * 9
        self.assertEqual(self.exchange(*pieces), 1009)

    def test_binary_messages_are_refused(self):
        self.assertEqual(self.exchange(frame(BINARY, b"1234")), 1003)

    def test_violations_of_the_protocol(self):
        for data in (frame(TEXT, CALL, masked=False), frame(TEXT, CALL, reserved=4),
                     frame(TEXT, CALL, reserved=1), frame(3, b"x"), frame(11, b"x"),
                     frame(0, b"continues nothing"), frame(PING, b"x" * 126),
                     frame(PING, b"x", fin=False), frame(CLOSE, b"x"),
                     frame(CLOSE, struct.pack(">H", 1005)), frame(CLOSE, struct.pack(">H", 999)),
                     frame(TEXT, b"a", fin=False) + frame(TEXT, b"b")):
            self.assertEqual(self.exchange(data), 1002, data)

    def test_text_that_is_not_utf8(self):
        for data in (b"\xff", b"\xc0\xaf", b"\xed\xa0\x80", b"\xf4\x90\x80\x80", b"abc\xe2\x82"):
            self.assertEqual(self.exchange(frame(TEXT, data)), 1007, data)
        split = frame(TEXT, b'"\xe2\x82', fin=False) + frame(0, b'\xac"')
        self.assertEqual(self.answer(split)["error"]["code"], -32600)

    def test_close_is_answered(self):
        for code in (1000, 1001, 3000, 4999):
            self.assertEqual(self.exchange(frame(CLOSE, struct.pack(">H", code) + b"bye")), code)
        self.assertIn(self.exchange(frame(CLOSE)), (1000, 1005))

    def test_bad_upgrades(self):
        for headers in ({"Sec_WebSocket_Version": "8"}, {"Sec_WebSocket_Key": None},
                        {"Sec_WebSocket_Version": None}):
            with RawSocket(self.server) as raw:
                status, _ = raw.upgrade(**headers)
                self.assertIn(status, (400, 426), headers)

    def test_ambiguous_requests_are_refused_and_their_connection_ends(self):
        post, host = "POST /rpc HTTP/1.1", "Host: 127.0.0.1"
        hidden = "GET /metrics HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n"
        for lines in (["GET / HTTP/1.1", host, "Host: evil.example"],
                      ["GET / HTTP/1.1", host, host], ["GET / HTTP/1.1"],
                      ["GET / HTTP/1.1", "Host: 127.0.0.1, evil.example"],
                      [post, host, "Content-Length: 5", "Content-Length: 5"],
                      [post, host, "Content-Length: 5", "Content-Length: 0"],
                      [post, host, "Content-Length: 5, 5"],
                      [post, host, "Content-Length: 5", "Transfer-Encoding: chunked"],
                      [post, host, "Transfer-Encoding: chunked", "Content-Length: 5"],
                      [post, host, "Transfer-Encoding: gzip"],
                      [post, host, "Transfer-Encoding: chunked, identity"],
                      ["POST /rpc HTTP/1.0", host, "Transfer-Encoding: chunked"],
                      ["GET / HTTP/1.1", host, "X-First: a", " folded"],
                      ["GET / HTTP/1.1", " " + host], ["GET / HTTP/1.1", host, "X: a\rY: b"],
                      ["GET / HTTP/1.1", host, "X: a\nContent-Length: 5"],
                      ["GET / HTTP/1.1\nHost: 127.0.0.1"]):
            with RawSocket(self.server) as raw:
                raw.send(("\r\n".join(lines) + "\r\n\r\n" + hidden).encode())
                answer = raw.read_until(b"\r\n\r\n")
                self.assertTrue(answer.startswith(b"HTTP/1.1 400 "), (lines, answer))
                self.assertIn(b"connection: close", answer.lower(), lines)
                with self.assertRaises(ConnectionError):
                    raw.read_until(b"HTTP/1.1 200")

    def test_trailers_are_no_headers(self):
        call = b"%x\r\n%s\r\n0\r\n" % (len(CALL), CALL)
        for trailer in (b"Origin: https://evil.example\r\n", b"Host: evil.example\r\n", b""):
            with RawSocket(self.server) as raw:
                raw.send(b"POST /rpc HTTP/1.1\r\nHost: 127.0.0.1\r\nTransfer-Encoding: chunked\r\n"
                         b"\r\n" + call + trailer + b"\r\n")
                answer = raw.read_until(b"\r\n\r\n")
                self.assertTrue(answer.startswith(b"HTTP/1.1 200 "), (trailer, answer))

    def test_a_head_may_come_byte_by_byte_and_with_the_next_request(self):
        request = b"GET /health/live HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n"
        with RawSocket(self.server) as raw:
            for i in range(len(request)):
                raw.send(request[i:i + 1])
            raw.read_until(b"live\n")
            raw.send(request + request + request[:30])
            raw.read_until(b"live\n")
            raw.read_until(b"live\n")
            raw.send(request[30:])
            raw.read_until(b"live\n")

    def test_requests_that_are_not_http(self):
        for data in (b"\x16\x03\x01\x02\x00\x01\x00\x01\xfc\x03\x03", b"nonsense\r\n\r\n",
                     b"GET / HTTP/9.9\r\n\r\n", b"GET  \r\n\r\n", b"\r\n" * 100,
                     b"GET / HTTP/1.1\r\nHost: 127.0.0.1\r\nContent-Length: x\r\n\r\n",
                     b"GET / HTTP/1.1\r\n" + b"A: b\r\n" * 5000 + b"\r\n",
                     b"POST /rpc HTTP/1.1\r\nHost: 127.0.0.1\r\nTransfer-Encoding: chunked\r\n\r\n"
                     b"FFFFFFFFFFFFFFFF\r\nx"):
            with RawSocket(self.server, timeout=12) as raw:
                raw.send(data)
                try:
                    raw.socket.shutdown(1)
                    head = raw.read_until(b"\r\n")
                    self.assertRegex(head, rb"HTTP/1\.1 4\d\d")
                except (ConnectionError, OSError):
                    pass  # closed without a word is an answer, too

    def test_silent_connections_time_out(self):
        begin = time.monotonic()
        with RawSocket(self.server, timeout=25) as raw:
            raw.send(b"GET / HTTP/1.1\r\nHost: 127.0.0.1\r\n")
            self.assertRaises(ConnectionError, raw.read, 1)
        self.assertLess(time.monotonic() - begin, 20)

    async def test_clients_that_do_not_read_are_disconnected(self):
        def gone():
            return b"heliograph_viewers 0\n" in self.server.get("/metrics")[2]
        self.server.wait_for(gone, "the leaving of earlier viewers")
        call = b'{"jsonrpc":"2.0","id":1,"method":"rpc.discover"}'
        with RawSocket(self.server, receive_buffer=4096) as raw:
            raw.upgrade()
            self.server.wait_for(lambda: not gone(), "a viewer")
            for _ in range(900):
                raw.send(frame(TEXT, call))
            self.server.wait_for(gone, "the end of the viewer")
        assert_less_memory(self, self.server.memory_bytes(), 2e9)

    async def test_random_bytes_do_not_disturb_a_viewer(self):
        chance = random.Random(7)
        async with Viewer(self.server) as viewer, viewer.moving():
            for _ in range(60):
                with RawSocket(self.server) as raw:
                    raw.upgrade()
                    raw.send(self.mutated(chance))
                await viewer.next_frame()
            await viewer.call("camera.get")

    def mutated(self, chance):
        """A valid call with some bytes changed, in a frame that may be changed as well."""
        message = bytearray(chance.choice([CALL, b'{"jsonrpc":"2.0","method":"camera.set",'
                                                 b'"params":{"eye":[1,2,3],"seq":1}}']))
        for _ in range(chance.randrange(4)):
            message[chance.randrange(len(message))] = chance.randrange(32, 127)
        framed = bytearray(frame(TEXT, bytes(message)))
        if chance.random() < 0.5:
            framed[chance.randrange(min(6, len(framed)))] = chance.randrange(256)
        if chance.random() < 0.2:
            framed += os.urandom(chance.randrange(100))
        return bytes(framed)
