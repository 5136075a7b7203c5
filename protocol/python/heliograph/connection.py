"""One WebSocket of heliograph.v1: calls with answers, notifications, frames. asyncio."""

import asyncio
import base64
import collections
import json
import urllib.parse

import websockets

from .errors import HeliographError
from .pictures import Frame

SUBPROTOCOL = "heliograph.v1"


def websocket_address(url, session):
    """"http://host:8080/" or "host:8080" -> "ws://host:8080/ws?session=main"."""
    if "://" not in url:
        url = "http://" + url
    parts = urllib.parse.urlsplit(url)
    scheme = {"http": "ws", "https": "wss", "ws": "ws", "wss": "wss"}[parts.scheme]
    query = urllib.parse.urlencode({"session": session}) if session else ""
    return urllib.parse.urlunsplit((scheme, parts.netloc, "/ws", query, ""))


def offered_subprotocols(token):
    """The token goes as a second subprotocol, where it is in no address and in no log."""
    if not token:
        return [SUBPROTOCOL]
    encoded = base64.urlsafe_b64encode(token.encode()).decode().rstrip("=")
    return [SUBPROTOCOL, f"{SUBPROTOCOL}.token.{encoded}"]


class Connection:
    """Frames are acknowledged when they are taken: whoever is slow gets fewer, not later ones."""

    def __init__(self, socket):
        self._socket = socket
        self._answers = {}
        self._next_id = 0
        self._frames = collections.deque()
        self._frame_came = asyncio.Event()
        self._listeners = collections.defaultdict(list)
        self._ended = None
        self._reader = asyncio.ensure_future(self._read())

    @classmethod
    async def open(cls, url, *, session=None, token=None, timeout=30):
        socket = await asyncio.wait_for(
            websockets.connect(websocket_address(url, session), max_size=None, compression=None,
                               subprotocols=offered_subprotocols(token)), timeout)
        return cls(socket)

    async def close(self):
        await self._socket.close()
        await self._reader

    async def call(self, method, params, timeout=300):
        """Gives the result. Raises HeliographError when the server refuses, ConnectionError when
        there is no connection any more."""
        if self._ended:
            raise ConnectionError(self._ended)
        self._next_id += 1
        number = self._next_id
        answer = self._answers[number] = asyncio.get_running_loop().create_future()
        await self._send({"jsonrpc": "2.0", "id": number, "method": method, "params": params})
        try:
            return await asyncio.wait_for(answer, timeout)
        finally:
            self._answers.pop(number, None)

    def listen(self, method, callback):
        """Calls `callback(params)` at every notification of that name. Gives a function that ends
        it."""
        self._listeners[method].append(callback)
        return lambda: self._listeners[method].remove(callback)

    async def next_frame(self, timeout=60):
        """Waits for a picture of the stream and acknowledges it."""
        async def wait():
            while not self._frames:
                if self._ended:
                    raise ConnectionError(self._ended)
                self._frame_came.clear()
                await self._frame_came.wait()
        await asyncio.wait_for(wait(), timeout)
        frame = self._frames.popleft()
        await self._send({"jsonrpc": "2.0", "method": "stream.ack",
                          "params": {"frame_seq": frame.header["frame_seq"]}})
        return frame

    async def _send(self, message):
        try:
            await self._socket.send(json.dumps(message))
        except websockets.ConnectionClosed as closed:
            raise ConnectionError(str(closed)) from closed

    async def _read(self):
        try:
            async for message in self._socket:
                if isinstance(message, str):
                    self._take(json.loads(message))
                else:
                    self._frames.append(Frame.parse(message))
                    self._frame_came.set()
            self._ended = "the server closed the connection"
        except websockets.ConnectionClosed as closed:
            self._ended = str(closed)
        for answer in self._answers.values():
            if not answer.done():
                answer.set_exception(ConnectionError(self._ended))
        self._frame_came.set()

    def _take(self, message):
        if "method" in message:
            for callback in list(self._listeners[message["method"]]):
                callback(message.get("params", {}))
            return
        answer = self._answers.get(message.get("id"))
        if answer is None or answer.done():
            return
        if "error" in message:
            answer.set_exception(HeliographError(message["error"]))
        else:
            answer.set_result(message["result"])
