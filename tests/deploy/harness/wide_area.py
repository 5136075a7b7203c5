"""A slow link with latency and loss between two network namespaces, made of two TUN devices; the
kernel's own TCP runs over it. As a program:
wide_area.py NAMESPACE LINE_AS_JSON"""

import ctypes
import fcntl
import heapq
import json
import os
import random
import select
import struct
import subprocess
import sys
import time

from dataclasses import asdict, dataclass

NEAR, FAR = "10.214.7.1", "10.214.7.2"
DEVICE = "hgwide0"
_TUNSETIFF, _IFF_TUN, _IFF_NO_PI = 0x400454CA, 0x0001, 0x1000


@dataclass
class Line:
    """Of each direction."""

    bytes_per_second: float = 125e3
    queue_bytes: int = 32 * 1024
    delay_seconds: float = 0.04
    jitter_seconds: float = 0.01
    loss: float = 0.01


class WideArea:
    """A context manager: the machine's address is FAR."""

    def __init__(self, machine, line):
        self.machine, self.line = machine, line
        self._process = None

    def __enter__(self):
        self._process = subprocess.Popen(
            [sys.executable, os.path.abspath(__file__), f"/run/netns/{self.machine.name}",
             json.dumps(asdict(self.line))], stdout=subprocess.PIPE, text=True)
        if self._process.stdout.readline() != "ready\n":
            raise RuntimeError("the line could not be made")
        return self

    def __exit__(self, *_):
        self._process.terminate()
        self._process.wait()
        self._process.stdout.close()


class Direction:
    """Packets leave in order, after the transmission time of the queue and the delay."""

    def __init__(self, line, target):
        self.line, self.target = line, target
        self.waiting = []
        self.free_at = self.last_at = 0.0
        self.count = 0

    def take(self, packet, now):
        line = self.line
        backlog = max(self.free_at - now, 0.0) * line.bytes_per_second
        if backlog > line.queue_bytes or random.random() < line.loss:
            return
        self.free_at = max(self.free_at, now) + len(packet) / line.bytes_per_second
        at = self.free_at + line.delay_seconds + random.uniform(0, line.jitter_seconds)
        self.last_at = max(self.last_at, at)
        self.count += 1
        heapq.heappush(self.waiting, (self.last_at, self.count, packet))

    def deliver(self, now):
        while self.waiting and self.waiting[0][0] <= now:
            try:
                os.write(self.target, heapq.heappop(self.waiting)[2])
            except OSError:
                pass  # the receiver's queue is full: drop, as a network would


def _enter(namespace):
    with open(namespace, "rb") as file:
        if ctypes.CDLL(None, use_errno=True).setns(file.fileno(), 0) != 0:
            raise OSError(ctypes.get_errno(), f"setns {namespace}")


def _open_device(address, peer):
    device = os.open("/dev/net/tun", os.O_RDWR | os.O_NONBLOCK)
    fcntl.ioctl(device, _TUNSETIFF, struct.pack("16sH22x", DEVICE.encode(),
                                                _IFF_TUN | _IFF_NO_PI))
    subprocess.run(["ip", "addr", "add", address, "peer", peer, "dev", DEVICE], check=True)
    subprocess.run(["ip", "link", "set", DEVICE, "mtu", "1400", "up"], check=True)
    return device


def main():
    namespace, line = sys.argv[1], Line(**json.loads(sys.argv[2]))
    near = _open_device(NEAR, FAR)
    _enter(namespace)
    far = _open_device(FAR, NEAR)
    outward, homeward = Direction(line, far), Direction(line, near)
    print("ready", flush=True)
    while True:
        pending = [way.waiting[0][0] for way in (outward, homeward) if way.waiting]
        pause = max(min(pending) - time.monotonic(), 0.0) if pending else 1.0
        readable, _, _ = select.select([near, far], [], [], pause)
        now = time.monotonic()
        for device, way in ((near, outward), (far, homeward)):
            if device in readable:
                way.take(os.read(device, 65536), now)
        outward.deliver(now)
        homeward.deliver(now)


if __name__ == "__main__":
    main()
