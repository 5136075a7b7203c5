"""RFC 6455, case by case, by a client that knows nothing of any library. Each case has a connection
of its own. What the server sends is checked as well: unmasked, no reserved bits, shortest lengths,
control frames whole and small."""

import base64
import hashlib
import json
import os
import struct
import unittest

from harness.raw_socket import BINARY, CLOSE, PING, PONG, TEXT, RawSocket, frame
from harness.server import ServerTestCase

CONTINUED = 0
CALL = json.dumps({"jsonrpc": "2.0", "id": 5, "method": "camera.get"}).encode()
CALLS_AT_ONCE = 200


def padded(size):
    return CALL + b" " * (size - len(CALL))


def call_with(text):
    """A call that carries any text and is answered."""
    return b'{"jsonrpc":"2.0","id":5,"method":"camera.get","params":{"x":"' + text + b'"}}'


def close(code, reason=b""):
    return frame(CLOSE, struct.pack(">H", code) + reason)


def raw_length(kind, size_bytes, payload):
    """A masked text whose length is written in more bytes than it needs."""
    mask = os.urandom(4)
    head = bytes([0x81, 0x80 | kind]) + len(payload).to_bytes(size_bytes, "big")
    return head + mask + bytes(byte ^ mask[i % 4] for i, byte in enumerate(payload))


def zero_masked(payload):
    return bytes([0x81, 0x80 | len(payload)]) + bytes(4) + payload


# name, what is sent, what must come of it: "answer" (the call is answered), a JSON-RPC error code,
# or {close codes}.
LENGTHS = [
    *[(f"text of {size} bytes", [frame(TEXT, padded(size))], "answer")
      for size in (len(CALL), 125, 126, 127, 128, 1000, 65534, 65535, 65536)],
    ("text of no bytes", [frame(TEXT, b"")], -32700),
    ("text one byte over the limit", [frame(TEXT, padded(65537))], {1009}),
    ("a length of a terabyte, announced", [frame(TEXT, b"", length=1 << 40)], {1009}),
    ("a length with the highest bit", [frame(TEXT, b"", length=1 << 63)], {1002, 1009}),
    ("a short length in two bytes", [raw_length(126, 2, padded(100))], {1002}),
    ("a short length in eight bytes", [raw_length(127, 8, padded(100))], {1002}),
    ("a middle length in eight bytes", [raw_length(127, 8, padded(1000))], {1002}),
    ("fragments over the limit together",
     [frame(TEXT, b" " * 40000, fin=False), frame(CONTINUED, b" " * 40000)], {1009}),
]
CONTROL = [
    ("ping without payload", [frame(PING)], ("pongs", [b""])),
    ("ping with payload", [frame(PING, b"\x00\xff hello")], ("pongs", [b"\x00\xff hello"])),
    ("ping of 125 bytes", [frame(PING, b"p" * 125)], ("pongs", [b"p" * 125])),
    ("ping of 126 bytes", [frame(PING, b"p" * 126)], {1002}),
    ("ping in single bytes", [bytes([byte]) for byte in frame(PING, b"chopped")],
     ("pongs", [b"chopped"])),
    ("fragmented ping", [frame(PING, b"p", fin=False)], {1002}),
    ("unasked pong", [frame(PONG, b"x"), frame(TEXT, CALL)], "answer"),
    ("unasked empty pongs", [frame(PONG) * 10, frame(TEXT, CALL)], "answer"),
    ("pong of 126 bytes", [frame(PONG, b"p" * 126)], {1002}),
    ("fragmented close", [frame(CLOSE, b"", fin=False)], {1002}),
]
RESERVED = [
    *[(f"reserved bits {bits:03b} on text", [frame(TEXT, CALL, reserved=bits)], {1002})
      for bits in range(1, 8)],
    ("a reserved bit on ping", [frame(PING, b"x", reserved=2)], {1002}),
    ("a reserved bit on a continuation",
     [frame(TEXT, CALL[:9], fin=False), frame(CONTINUED, CALL[9:], reserved=1)], {1002}),
    *[(f"reserved opcode {opcode}", [frame(opcode, b"x")], {1002})
      for opcode in (3, 4, 5, 6, 7, 11, 12, 13, 14, 15)],
]
FRAGMENTS = [
    ("two fragments", [frame(TEXT, CALL[:7], fin=False), frame(CONTINUED, CALL[7:])], "answer"),
    ("an empty first fragment", [frame(TEXT, b"", fin=False), frame(CONTINUED, CALL)], "answer"),
    ("an empty last fragment", [frame(TEXT, CALL, fin=False), frame(CONTINUED, b"")], "answer"),
    ("empty fragments between",
     [frame(TEXT, CALL[:7], fin=False), *[frame(CONTINUED, b"", fin=False)] * 5,
      frame(CONTINUED, CALL[7:])], "answer"),
    ("a fragment for each byte",
     [frame(TEXT, CALL[:1], fin=False),
      *[frame(CONTINUED, CALL[i:i + 1], fin=False) for i in range(1, len(CALL))],
      frame(CONTINUED, b"")], "answer"),
    ("a whole message in single bytes", [bytes([byte]) for byte in frame(TEXT, CALL)], "answer"),
    ("ping between fragments",
     [frame(TEXT, CALL[:7], fin=False), frame(PING, b"between"), frame(CONTINUED, CALL[7:])],
     ("pongs", [b"between"], "answer")),
    ("pong between fragments",
     [frame(TEXT, CALL[:7], fin=False), frame(PONG, b"between"), frame(CONTINUED, CALL[7:])],
     "answer"),
    ("a continuation of nothing", [frame(CONTINUED, CALL)], {1002}),
    ("an unfinished continuation of nothing", [frame(CONTINUED, CALL, fin=False)], {1002}),
    ("a continuation after the end",
     [frame(TEXT, CALL[:7], fin=False), frame(CONTINUED, CALL[7:]), frame(CONTINUED, b"x")],
     {1002}),
    ("text within fragments",
     [frame(TEXT, CALL[:7], fin=False), frame(TEXT, CALL[7:])], {1002}),
    ("binary within fragments",
     [frame(TEXT, CALL[:7], fin=False), frame(BINARY, CALL[7:])], {1002}),
    ("two messages at once", [frame(TEXT, CALL) + frame(TEXT, CALL)], "answer"),
    ("binary, which is of no use here", [frame(BINARY, b"\x00\x01")], {1003}),
]
MASKS = [
    ("text without mask", [frame(TEXT, CALL, masked=False)], {1002}),
    ("ping without mask", [frame(PING, b"x", masked=False)], {1002}),
    ("close without mask", [frame(CLOSE, b"\x03\xe8", masked=False)], {1002}),
    ("a mask of zeros", [zero_masked(padded(100))], "answer"),
]
UTF8 = [
    *[(f"valid: {name}", [frame(TEXT, call_with(text))], "answer") for name, text in (
        ("two bytes", "\u00e9\u07ff".encode()), ("three bytes", "\u0800\u20ac\ud7ff".encode()),
        ("after the surrogates", b"\xee\x80\x80"), ("four bytes", "\U00010000\U0010ffff".encode()),
        ("no characters", "\ufffe\uffff\U0001fffe".encode()), ("a mark of order", b"\xef\xbb\xbf"))],
    *[(f"invalid: {name}", [frame(TEXT, call_with(text))], {1007}) for name, text in (
        ("a lone continuation", b"\x80"), ("two continuations", b"\xbf\xbf"),
        ("a lone start", b"\xc3 "), ("a start cut short", b"\xe2\x82"),
        ("two bytes for one", b"\xc0\xaf"), ("two bytes for 127", b"\xc1\xbf"),
        ("three bytes for one", b"\xe0\x80\xaf"), ("four bytes for one", b"\xf0\x80\x80\xaf"),
        ("a high surrogate", b"\xed\xa0\x80"), ("a low surrogate", b"\xed\xbf\xbf"),
        ("beyond the last", b"\xf4\x90\x80\x80"), ("five bytes", b"\xf8\x88\x80\x80\x80"),
        ("a byte that never is", b"\xfe"))],
    ("a character over two fragments",
     [frame(TEXT, call_with(b"\xe2")[:-3], fin=False), frame(CONTINUED, b"\x82\xac\"}}")],
     "answer"),
    ("a character over many fragments",
     [frame(TEXT, call_with(b"")[:-3], fin=False),
      *[frame(CONTINUED, bytes([byte]), fin=False) for byte in "\U0001f600".encode()],
      frame(CONTINUED, b'"}}')], "answer"),
    ("a character that the message's end cuts off",
     [frame(TEXT, CALL, fin=False), frame(CONTINUED, b"\xe2\x82")], {1007}),
    ("invalid in the first of fragments, without their end",
     [frame(TEXT, b'"\xff', fin=False)], {1007}),
    ("invalid in a later fragment, without the end",
     [frame(TEXT, b'"abc', fin=False), frame(CONTINUED, b"\xc0\x80", fin=False)], {1007}),
    ("text that is no JSON", [frame(TEXT, b"hello")], -32700),
]
CLOSING = [
    *[(f"close {code}", [close(code, b"bye")], {code})
      for code in (1000, 1001, 1002, 1003, 1007, 1008, 1009, 1010, 1011, 3000, 3999, 4000, 4999)],
    *[(f"close {code}, which must not be sent", [close(code)], {1002})
      for code in (0, 999, 1004, 1005, 1006, 1015, 1016, 1100, 2000, 2999, 5000, 65535)],
    ("close without code", [frame(CLOSE)], {1000, 1005}),
    ("close with half a code", [frame(CLOSE, b"\x03")], {1002}),
    ("close with the longest reason", [close(1000, b"r" * 123)], {1000}),
    ("close with too long a reason", [close(1000, b"r" * 124)], {1002}),
    ("close with a reason that is not UTF-8", [close(1000, b"\xff")], {1002, 1007}),
    ("close with a character cut off", [close(1000, b"\xe2\x82")], {1002, 1007}),
    ("close, then data", [close(1000) + frame(TEXT, CALL)], {1000}),
    ("close, then a ping", [close(1000) + frame(PING, b"x")], {1000}),
    ("close twice", [close(1000) + close(1001)], {1000}),
    ("close within fragments", [frame(TEXT, CALL[:7], fin=False), close(1000)], {1000}),
]


class CheckedSocket(RawSocket):
    """Also checks every frame of the server."""

    def read_frame(self):
        first, second = self.read(2)
        opcode, size = first & 0x0F, second & 0x7F
        assert first & 0x70 == 0, "the server sets reserved bits"
        assert second & 0x80 == 0, "the server masks"
        if size == 126:
            size, = struct.unpack(">H", self.read(2))
            assert size > 125, "the server's length is not the shortest"
        elif size == 127:
            size, = struct.unpack(">Q", self.read(8))
            assert size > 65535, "the server's length is not the shortest"
        if opcode >= CLOSE:
            assert first & 0x80 and size <= 125, "the server's control frame is not whole or small"
        payload = self.read(size)
        if opcode == TEXT:
            payload.decode("utf-8")
        if opcode == CLOSE and payload:
            payload[2:].decode("utf-8")
        return opcode, payload


class Conformance(ServerTestCase):
    def setUp(self):
        pass

    def run_cases(self, cases):
        for name, pieces, expected in cases:
            with self.subTest(name), CheckedSocket(self.server) as raw:
                self.assertEqual(raw.upgrade()[0], 101)
                try:
                    for piece in pieces:
                        raw.send(piece)
                except (BrokenPipeError, ConnectionResetError):
                    pass  # the server has heard enough
                self.check(raw, expected)
            self.assertTrue(self.server.alive, name)

    def check(self, raw, expected):
        if isinstance(expected, set):
            code = raw.close_code()
            self.assertIn(code if code is not None else "closed without a close frame", expected)
            return
        pongs, expected = (expected[1], expected[2:]) if isinstance(expected, tuple) else ([],
                                                                                          (expected,))
        for payload in pongs:
            self.assertEqual(raw.read_frame(), (PONG, payload))
        for outcome in expected:
            opcode, payload = raw.read_frame()
            self.assertEqual(opcode, TEXT, payload)
            answer = json.loads(payload)
            if outcome == "answer":
                self.assertEqual(answer["id"], 5)
                self.assertIn("result", answer)
            else:
                self.assertEqual(answer["error"]["code"], outcome)

    def test_lengths(self):
        self.run_cases(LENGTHS)

    def test_control_frames(self):
        self.run_cases(CONTROL)

    def test_reserved_bits_and_opcodes(self):
        self.run_cases(RESERVED)

    def test_fragments(self):
        self.run_cases(FRAGMENTS)

    def test_masks(self):
        self.run_cases(MASKS)

    def test_utf8(self):
        self.run_cases(UTF8)

    def test_closing(self):
        self.run_cases(CLOSING)

    def test_there_are_at_least_100_cases(self):
        cases = [*LENGTHS, *CONTROL, *RESERVED, *FRAGMENTS, *MASKS, *UTF8, *CLOSING]
        names = [name for name, _, _ in cases]
        self.assertEqual(len(names), len(set(names)))
        self.assertGreaterEqual(len(names), 100)

    def test_ten_pings_at_once(self):
        with CheckedSocket(self.server) as raw:
            raw.upgrade()
            raw.send(b"".join(frame(PING, bytes([i])) for i in range(10)))
            pongs = []
            while b"\x09" not in pongs:
                opcode, payload = raw.read_frame()
                self.assertEqual(opcode, PONG)
                pongs.append(payload)
            self.assertEqual(pongs, sorted(pongs), "in order; only the last must be answered")


class Handshake(ServerTestCase):
    def setUp(self):
        pass

    def test_accept_header_matches_the_key(self):
        for _ in range(3):
            key = base64.b64encode(os.urandom(16)).decode()
            with RawSocket(self.server) as raw:
                status, head = raw.upgrade(Sec_WebSocket_Key=key)
            self.assertEqual(status, 101)
            digest = hashlib.sha1((key + "258EAFA5-E914-47DA-95CA-C5AB0DC85B11").encode()).digest()
            headers = dict(line.split(": ", 1) for line in head.split("\r\n")[1:] if line)
            headers = {name.lower(): value for name, value in headers.items()}
            self.assertEqual(headers["sec-websocket-accept"], base64.b64encode(digest).decode())
            self.assertEqual(headers["upgrade"].lower(), "websocket")
            self.assertEqual(headers["connection"].lower(), "upgrade")
            self.assertEqual(headers["sec-websocket-protocol"], "heliograph.v1")
            self.assertNotIn("sec-websocket-extensions", headers)

    def test_valid_handshakes_are_accepted(self):
        for headers in ({"Upgrade": "WebSocket"}, {"Connection": "keep-alive, Upgrade"},
                        {"Sec_WebSocket_Extensions": "permessage-deflate; client_max_window_bits"},
                        {"Sec_WebSocket_Protocol": "chat, heliograph.v1, other"}):
            with RawSocket(self.server) as raw:
                status, head = raw.upgrade(**headers)
                self.assertEqual(status, 101, headers)
                self.assertNotIn("sec-websocket-extensions", head.lower())
                raw.send(frame(TEXT, CALL))
                self.assertEqual(raw.read_frame()[0], TEXT)

    def test_invalid_handshakes_are_refused(self):
        for headers in ({"Sec_WebSocket_Key": None}, {"Sec_WebSocket_Key": ""},
                        {"Sec_WebSocket_Key": "short"}, {"Sec_WebSocket_Key": "A" * 200},
                        {"Sec_WebSocket_Version": None}, {"Sec_WebSocket_Version": "8"},
                        {"Sec_WebSocket_Version": "14"}, {"Sec_WebSocket_Version": "x"},
                        {"Connection": "keep-alive"}, {"Connection": None}, {"Upgrade": None},
                        {"Upgrade": "h2c"}, {"Sec_WebSocket_Protocol": None},
                        {"Sec_WebSocket_Protocol": "heliograph.v2"}):
            with RawSocket(self.server) as raw:
                status, _ = raw.upgrade(**headers)
                self.assertIn(status, (400, 426), headers)

    def test_other_methods_and_versions_are_refused(self):
        head = (f"Host: {self.server.host}:{self.server.port}\r\nUpgrade: websocket\r\n"
                "Connection: Upgrade\r\nSec-WebSocket-Version: 13\r\n"
                "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n"
                "Sec-WebSocket-Protocol: heliograph.v1\r\n\r\n")
        for request in ("POST /ws HTTP/1.1", "PUT /ws HTTP/1.1", "GET /ws HTTP/1.0"):
            with RawSocket(self.server) as raw:
                raw.send(f"{request}\r\n{head}".encode())
                self.assertRegex(raw.read_until(b"\r\n"), rb"HTTP/1\.1 4\d\d", request)

    def test_unsupported_websocket_versions_get_the_supported_one(self):
        with RawSocket(self.server) as raw:
            status, head = raw.upgrade(Sec_WebSocket_Version="8")
            self.assertEqual(status, 426)
            self.assertIn("sec-websocket-version: 13", head.lower())

class RateLimits(ServerTestCase):
    def setUp(self):
        pass

    def exchange(self, raw, count):
        """Sends calls at once and reads their answers: how many were answered and refused."""
        raw.send(frame(TEXT, b'{"jsonrpc":"2.0","id":1,"method":"camera.get"}') * count)
        answered = refused = 0
        while answered + refused < count:
            opcode, payload = raw.read_frame()
            if opcode == CLOSE:
                raise ConnectionError(payload)
            message = json.loads(payload) if opcode == TEXT else {}
            if "result" in message:
                answered += 1
            elif "error" in message:
                self.assertEqual(message["error"]["code"], -32002)
                self.assertEqual(message["id"], 1)
                self.assertIn("500", message["error"]["data"]["limit"])
                refused += 1
        return answered, refused

    def test_message_floods_are_rate_limited_then_disconnected(self):
        answered = refused = 0
        with RawSocket(self.server) as raw:
            raw.upgrade()
            raw.send(frame(TEXT, b'{"jsonrpc":"2.0","id":0,"method":"hello"}'))
            while raw.read_frame()[0] != TEXT:
                pass
            with self.assertRaises((ConnectionError, OSError)):
                for _ in range(2000):
                    more = self.exchange(raw, CALLS_AT_ONCE)
                    answered, refused = answered + more[0], refused + more[1]
        self.assertGreaterEqual(answered, 1000)
        # All but those of the last exchange, which the end of the connection cuts off.
        self.assertGreaterEqual(refused, 1000 - CALLS_AT_ONCE)

    def test_too_many_pings_end_the_connection(self):
        with RawSocket(self.server) as raw:
            raw.upgrade()
            try:
                for _ in range(50):
                    raw.send(frame(PING, b"x" * 125) * 100)
                self.assertIn(raw.close_code(), (1008, None))
            except (BrokenPipeError, ConnectionResetError):
                pass

    def test_some_pings_are_fine(self):
        with RawSocket(self.server) as raw:
            raw.upgrade()
            for _ in range(50):
                raw.send(frame(PING, b"x"))
                self.assertEqual(raw.read_frame(), (PONG, b"x"))


if __name__ == "__main__":
    unittest.main()
