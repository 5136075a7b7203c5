"""A viewer: one WebSocket, requests with answers, notifications, frames with acknowledgement."""

import asyncio
import base64
import contextlib
import json
import math
import struct
from dataclasses import dataclass

import websockets

from harness.server import TIME_FACTOR

SUBPROTOCOL = "heliograph.v1"

FLAG_KEY = 1
FLAG_FINAL = 2
FLAG_FIRST_AFTER_DROP = 4
FLAG_DISCONTINUITY = 8

_LAYOUT = struct.Struct("<4sBBBBHHIIIIHHHHHHQIIII")
_NAMES = ("magic version type codec flags header_bytes quality frame_seq render_id input_seq_echo "
          "state_rev width height x y full_width full_height render_start_us render_us encode_us "
          "queue_us sample_count").split()


@dataclass
class Frame:
    header: dict
    payload: bytes
    received_at: float

    @classmethod
    def parse(cls, message, received_at):
        header = dict(zip(_NAMES, _LAYOUT.unpack_from(message)))
        return cls(header, message[header["header_bytes"]:], received_at)

    @property
    def final(self):
        return bool(self.header["flags"] & FLAG_FINAL)


class Viewer:
    """Use with `async with`. Acknowledges every frame by default."""

    def __init__(self, server, *, acknowledge=True, greet=True, session=None, name=None,
                 port=None, token=None):
        self.server = server
        self.url = f"ws://{server.host}:{port}/ws" if port else server.websocket_url
        self.acknowledge = acknowledge
        self.greet = greet
        self.session = session
        self.name = name
        self.subprotocols = [SUBPROTOCOL]
        if token:
            secret = base64.urlsafe_b64encode(token.encode()).decode().rstrip("=")
            self.subprotocols.append(f"{SUBPROTOCOL}.token.{secret}")
        self.frames = asyncio.Queue()
        self.last = None  # the newest frame that was looked at
        self.frames_received = 0
        self.bytes_received = 0
        self.notifications = []
        self.unasked = asyncio.Queue()  # answers without a known id
        self._answers = {}
        self._next_id = 1

    async def __aenter__(self):
        url = self.url + (f"?session={self.session}" if self.session else "")
        self.socket = await websockets.connect(url, max_size=None, ssl=self.server.tls,
                                               subprotocols=self.subprotocols, compression=None)
        self._reader = asyncio.create_task(self._read())
        if self.greet:
            person = {"name": self.name} if self.name else {}
            self.hello = await self.call("hello", {"client": "protocol tests", **person})
        return self

    async def __aexit__(self, *_):
        # A viewer that reads nothing may have been disconnected before it could close.
        with contextlib.suppress(websockets.ConnectionClosed):
            await self.socket.close()
        await self._reader

    async def closed(self, timeout=15):
        """Waits for the end of the connection; returns close code and reason."""
        await asyncio.wait_for(asyncio.shield(self._reader), timeout * TIME_FACTOR)
        return self.socket.close_code, self.socket.close_reason

    async def _read(self):
        loop = asyncio.get_running_loop()
        try:
            async for message in self.socket:
                self.bytes_received += len(message)
                if isinstance(message, bytes):
                    frame = Frame.parse(message, loop.time())
                    self.frames_received += 1
                    self.frames.put_nowait(frame)
                    if self.acknowledge:
                        # What came before the end of the connection is still to be read.
                        with contextlib.suppress(websockets.ConnectionClosed):
                            await self.notify("stream.ack",
                                              {"frame_seq": frame.header["frame_seq"]})
                else:
                    self._take(json.loads(message))
        except websockets.ConnectionClosed:
            pass
        for waiting in self._answers.values():
            waiting.cancel()

    def _take(self, message):
        if isinstance(message, dict) and "method" in message:
            self.notifications.append(message)
            return
        waiting = self._answers.pop(message.get("id"), None) if isinstance(message, dict) else None
        if waiting:
            if not waiting.done():  # its caller may have given up
                waiting.set_result(message)
        else:
            self.unasked.put_nowait(message)

    async def send(self, text):
        await self.socket.send(text)

    async def notify(self, method, params):
        await self.send(json.dumps({"jsonrpc": "2.0", "method": method, "params": params}))

    async def ask(self, method, params=None, timeout=60):
        """The whole answer, result or error."""
        number = self._next_id
        self._next_id += 1
        waiting = asyncio.get_running_loop().create_future()
        self._answers[number] = waiting
        await self.send(json.dumps(
            {"jsonrpc": "2.0", "id": number, "method": method, "params": params or {}}))
        return self.server.seen(method, await asyncio.wait_for(waiting, timeout * TIME_FACTOR))

    async def call(self, method, params=None, timeout=60):
        answer = await self.ask(method, params, timeout)
        if "error" in answer:
            raise AssertionError(f"{method}: {answer['error']}")
        return answer["result"]

    async def next_frame(self, timeout=30):
        self.last = await asyncio.wait_for(self.frames.get(), timeout)
        return self.last

    async def frame_where(self, condition, timeout=60):
        """The next frame that fulfils the condition; others are skipped."""
        async def search():
            while True:
                self.last = await self.frames.get()
                if condition(self.last):
                    return self.last
        return await asyncio.wait_for(search(), timeout * TIME_FACTOR)

    @contextlib.asynccontextmanager
    async def moving(self, rate=60):
        """Moves the camera in a circle in the background, so that frames keep coming."""
        async def orbit():
            angle = 0.0
            while True:
                angle += 0.02
                await self.notify("camera.set",
                                  {"eye": [3 * math.cos(angle), 2, 3 * math.sin(angle)]})
                await asyncio.sleep(1 / rate)
        task = asyncio.create_task(orbit())
        try:
            yield
        finally:
            task.cancel()
            with contextlib.suppress(asyncio.CancelledError):
                await task

    async def rest(self, timeout=60):
        """Waits for the final frame of the current state, after which nothing should be sent. It may
        have been looked at already."""
        rev = (await self.call("camera.get"))["rev"]

        def stays(frame):
            return frame.final and frame.header["state_rev"] >= rev
        if self.last and stays(self.last) and self.frames.empty():
            return self.last
        return await self.frame_where(stays, timeout)

    async def progress_with(self, stage, timeout=15):
        """The progress of a load in this stage."""
        deadline = asyncio.get_running_loop().time() + timeout * TIME_FACTOR
        while asyncio.get_running_loop().time() < deadline:
            for message in self.notifications:
                if message["method"] == "scene.progress" and message["params"]["stage"] == stage:
                    return message["params"]
            await asyncio.sleep(0.02)
        raise AssertionError(f"no progress {stage} in {timeout} s")

    async def notification(self, method, timeout=15):
        """The first notification of this name."""
        deadline = asyncio.get_running_loop().time() + timeout * TIME_FACTOR
        while asyncio.get_running_loop().time() < deadline:
            for message in self.notifications:
                if message["method"] == method:
                    return message["params"]
            await asyncio.sleep(0.02)
        raise AssertionError(f"no {method} in {timeout} s")
