"""A WebSocket on the level of bytes, for messages that no library would send."""

import os
import socket
import struct

TEXT, BINARY, CLOSE, PING, PONG = 1, 2, 8, 9, 10


def frame(opcode, payload=b"", *, fin=True, masked=True, reserved=0, length=None,
          mask=None):
    """One WebSocket frame; `length` overrides the announced length, `mask` the random one."""
    size = len(payload) if length is None else length
    head = bytes([(0x80 if fin else 0) | reserved << 4 | opcode])
    mask_bit = 0x80 if masked else 0
    if size < 126:
        head += bytes([mask_bit | size])
    elif size < 65536:
        head += struct.pack(">BH", mask_bit | 126, size)
    else:
        head += struct.pack(">BQ", mask_bit | 127, size)
    if not masked:
        return head + payload
    mask = os.urandom(4) if mask is None else mask
    if not any(mask):
        return head + mask + payload
    return head + mask + bytes(byte ^ mask[i % 4] for i, byte in enumerate(payload))


class RawSocket:
    """A TCP connection that speaks HTTP and WebSocket byte by byte."""

    def __init__(self, server, *, receive_buffer=None, timeout=15):
        self.server = server
        self.socket = socket.socket(socket.AF_INET, socket.SOCK_STREAM)
        if receive_buffer:
            self.socket.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, receive_buffer)
        self.socket.settimeout(timeout)
        self.socket.connect((server.host, server.port))
        if server.tls:
            self.socket = server.tls.wrap_socket(self.socket, server_hostname=server.host)
        self.received = b""

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.socket.close()

    def send(self, data):
        self.socket.sendall(data)

    def upgrade(self, path="/ws", **headers):
        """Asks for a WebSocket; returns the status and the text of the answer. Headers replace the
        usual ones, None leaves one out."""
        fields = {"Host": f"{self.server.host}:{self.server.port}", "Upgrade": "websocket",
                  "Connection": "Upgrade", "Sec-WebSocket-Version": "13",
                  "Sec-WebSocket-Key": "dGhlIHNhbXBsZSBub25jZQ==",
                  "Sec-WebSocket-Protocol": "heliograph.v1"}
        fields.update({name.replace("_", "-"): value for name, value in headers.items()})
        lines = [f"{name}: {value}" for name, value in fields.items() if value is not None]
        self.send("\r\n".join([f"GET {path} HTTP/1.1", *lines, "", ""]).encode())
        head = self.read_until(b"\r\n\r\n").decode()
        status = int(head.split()[1])
        length = [line.split(":")[1] for line in head.lower().splitlines()
                  if line.startswith("content-length")]
        body = self.read(int(length[0])).decode() if length and status != 101 else ""
        return status, head + body

    def read(self, count):
        while len(self.received) < count:
            more = self.socket.recv(65536)
            if not more:
                raise ConnectionError("closed by the server")
            self.received += more
        data, self.received = self.received[:count], self.received[count:]
        return data

    def read_until(self, end):
        while end not in self.received:
            more = self.socket.recv(65536)
            if not more:
                raise ConnectionError("closed by the server")
            self.received += more
        data, _, self.received = self.received.partition(end)
        return data + end

    def read_frame(self):
        first, second = self.read(2)
        size = second & 0x7F
        if size == 126:
            size, = struct.unpack(">H", self.read(2))
        elif size == 127:
            size, = struct.unpack(">Q", self.read(8))
        return first & 0x0F, self.read(size)

    def close_code(self):
        """Reads on until the server closes; None if it does so without a close frame."""
        try:
            while True:
                opcode, payload = self.read_frame()
                if opcode == CLOSE:
                    return struct.unpack(">H", payload[:2])[0] if payload else 1005
        except ConnectionError:
            return None
