"""A viewer's WebSocket for hundreds of them in one process: of frames it keeps the header only."""

import asyncio
import base64
import functools
import json
import os
import struct
import time
from dataclasses import dataclass

from harness.raw_socket import BINARY, CLOSE, PING, PONG, TEXT, frame
from harness.viewer import SUBPROTOCOL

_HEADER = struct.Struct("<12xI8xIHH4xHH")  # frame_seq, state_rev, size and full size
_MOST_HEADER = 64  # bytes


class Refused(Exception):
    """What the server said instead of letting a viewer in: a status, a close code or an error code."""

    def __init__(self, code):
        super().__init__(f"refused with {code}")
        self.code = code


@dataclass
class FrameNote:
    """What latencies and sizes follow from."""
    at: float
    state_rev: int
    scale: float  # of width and height
    bytes: int


# The mask protects proxies, which are none on the way; without it a frame costs no time.
masked = functools.partial(frame, mask=bytes(4))


class LoadSocket(asyncio.Protocol):
    def __init__(self, host):
        self.frames = []  # FrameNote
        self.acknowledge_after = 0.0  # seconds
        self.upgraded = asyncio.get_running_loop().create_future()
        self.ended = asyncio.get_running_loop().create_future()
        self.close_code = None
        self._host = host
        self._received = bytearray()
        self._read = self._read_head
        self._asked = 0
        self._answers = {}
        self._waiting = []  # (revision, future)
        self._left = 0  # bytes of the frame that is being received
        self._bytes = 0

    @classmethod
    async def open(cls, server, session=None, greet=True):
        """Connects and greets. Raises Refused."""
        socket = cls(f"{server.host}:{server.port}")
        await asyncio.get_running_loop().create_connection(lambda: socket, server.host, server.port)
        socket.ask_upgrade("/ws" + (f"?session={session}" if session else ""))
        try:
            status = await socket.upgraded
        except ConnectionError:
            raise Refused(None) from None
        if status != 101:
            raise Refused(status)
        if greet:
            await socket.call("hello", {"client": "load"})
        return socket

    def ask_upgrade(self, path):
        key = base64.b64encode(os.urandom(16)).decode()
        self.transport.write(
            f"GET {path} HTTP/1.1\r\nHost: {self._host}\r\nUpgrade: websocket\r\n"
            f"Connection: Upgrade\r\nSec-WebSocket-Version: 13\r\nSec-WebSocket-Key: {key}\r\n"
            f"Sec-WebSocket-Protocol: {SUBPROTOCOL}\r\n\r\n".encode())

    def notify(self, method, params):
        self._send({"jsonrpc": "2.0", "method": method, "params": params})

    def ask(self, method, params=None):
        """A future of the result; its exception is Refused."""
        answer = asyncio.get_running_loop().create_future()
        if self.ended.done():
            answer.set_exception(Refused(self.close_code))
            return answer
        self._asked += 1
        number = self._asked
        self._answers[number] = answer
        self._send({"jsonrpc": "2.0", "id": number, "method": method, "params": params or {}})
        return answer

    async def call(self, method, params=None):
        return await self.ask(method, params)

    async def frame_of(self, revision):
        """When a frame of this revision or a newer one had arrived."""
        if self.frames and self.frames[-1].state_rev >= revision:
            return self.frames[-1].at
        arrival = asyncio.get_running_loop().create_future()
        self._waiting.append((revision, arrival))
        return await arrival

    def abort(self):
        self.transport.abort()

    def _send(self, message):
        self.transport.write(masked(TEXT, json.dumps(message, separators=(",", ":")).encode()))

    # Called by the event loop.

    def connection_made(self, transport):
        self.transport = transport

    def data_received(self, data):
        self._received += data
        while self._read():
            pass

    def connection_lost(self, exc):
        gone = ConnectionResetError()
        for future in (self.upgraded, *self._answers.values(), *(one for _, one in self._waiting)):
            if not future.done():
                future.set_exception(gone if future is self.upgraded else Refused(self.close_code))
                future.exception()  # it may be that nothing waits for it any more
        if not self.ended.done():
            self.ended.set_result(time.monotonic())

    # Each reads a piece of what was received; whether there may be another one.

    def _read_head(self):
        end = self._received.find(b"\r\n\r\n")
        if end < 0:
            return False
        status = int(self._received.split(b" ", 2)[1])
        del self._received[:end + 4]
        self._read = self._read_frame
        if not self.upgraded.done():
            self.upgraded.set_result(status)
        if status != 101:
            self.transport.abort()
        return status == 101

    def _read_frame(self):
        data = self._received
        if len(data) < 2:
            return False
        opcode, size, begin = data[0] & 15, data[1] & 127, 2
        if size > 125:
            begin = 4 if size == 126 else 10
            if len(data) < begin:
                return False
            size = int.from_bytes(data[2:begin], "big")
        needed = min(size, _MOST_HEADER) if opcode == BINARY else size
        if len(data) < begin + needed:
            return False
        payload = bytes(data[begin:begin + needed])
        if opcode == BINARY:
            self._header, self._bytes, self._left = payload, size, size - needed
            del data[:begin + needed]
            self._read = self._skip
            return True
        del data[:begin + size]
        self._take(opcode, payload)
        return True

    def _skip(self):
        skipped = min(self._left, len(self._received))
        del self._received[:skipped]
        self._left -= skipped
        if self._left:
            return False
        self._read = self._read_frame
        self._take_frame()
        return True

    def _take_frame(self):
        number, revision, width, _, full_width, _ = _HEADER.unpack_from(self._header)
        now = time.monotonic()
        self.frames.append(FrameNote(now, revision, width / full_width, self._bytes))
        if self.acknowledge_after:
            asyncio.get_running_loop().call_later(self.acknowledge_after, self._acknowledge, number)
        else:
            self._acknowledge(number)
        for waiting in [one for one in self._waiting if one[0] <= revision]:
            self._waiting.remove(waiting)
            waiting[1].set_result(now)

    def _acknowledge(self, number):
        self.transport.write(masked(TEXT, b'{"jsonrpc":"2.0","method":"stream.ack",'
                                           b'"params":{"frame_seq":%d}}' % number))

    def _take(self, opcode, payload):
        if opcode == PING:
            self.transport.write(masked(PONG, payload))
        elif opcode == CLOSE:
            self.close_code = int.from_bytes(payload[:2], "big") if payload else 1005
            self.transport.write(masked(CLOSE, payload[:2]))
            self.transport.close()
        elif payload.startswith(b'{"id":'):  # notifications do not matter here
            message = json.loads(payload)
            answer = self._answers.pop(message.get("id"), None)
            if answer and not answer.done():
                if "error" in message:
                    answer.set_exception(Refused(message["error"]["code"]))
                    answer.exception()
                else:
                    answer.set_result(message["result"])
