"""Single servers in hardened containers, and what is asked of them over HTTP."""

import http.client
import json
import socket
import time
import urllib.parse

from .images import SERVER

TOKEN = "deployment-test-token"
HARDENED = ("--read-only", "--cap-drop", "ALL", "--security-opt", "no-new-privileges",
            "--tmpfs", "/tmp:size=64m,mode=1777,noexec,nosuid,nodev", "--pids-limit", "256")


class Container:
    """A running server; ends with `remove`."""

    def __init__(self, machine, name, *options, port=8080, serve=()):
        self.machine, self.name = machine, name
        self.url = f"http://{machine.address}:{port}/"
        self.started_at = time.monotonic()
        machine.docker("run", "--detach", "--name", name, *HARDENED, "--publish", f"{port}:8080",
                       "--env", f"HELIOGRAPH_TOKEN={TOKEN}", *options, SERVER, "serve", *serve)

    def wait_healthy(self, timeout=300):
        """Gives the seconds that it took."""
        while self.machine.docker("inspect", "--format", "{{.State.Health.Status}}",
                                  self.name) != "healthy":
            if time.monotonic() - self.started_at > timeout or not self.running():
                raise AssertionError(f"{self.name} is not healthy:\n{self.log()}")
            time.sleep(0.1)
        return time.monotonic() - self.started_at

    def running(self):
        return self.state()["Running"]

    def state(self):
        return self.machine.inspect(self.name, "{{json .State}}")

    def log(self):
        return self.machine.docker("logs", "--tail", "30", self.name, check=False)

    def remove(self):
        self.machine.docker("rm", "--force", "--volumes", self.name, check=False)

    def get(self, path, **options):
        return get(self.url + path, **options)


def free_port():
    """On this machine's loopback, at this moment."""
    with socket.create_server(("127.0.0.1", 0)) as server:
        return server.getsockname()[1]


def get(url, *, token=TOKEN, headers=None, timeout=60):
    """Status, headers and body of one exchange on a connection of its own."""
    address = urllib.parse.urlsplit(url)
    connection = http.client.HTTPConnection(address.hostname, address.port, timeout=timeout)
    try:
        path = address.path + ("?" + address.query if address.query else "")
        connection.request("GET", path, headers={"Authorization": f"Bearer {token}",
                                                 **(headers or {})})
        answer = connection.getresponse()
        return answer.status, dict(answer.getheaders()), answer.read()
    finally:
        connection.close()


def call(url, method, params=None, *, token=TOKEN, timeout=60):
    address = urllib.parse.urlsplit(url)
    connection = http.client.HTTPConnection(address.hostname, address.port, timeout=timeout)
    try:
        text = json.dumps({"jsonrpc": "2.0", "id": 1, "method": method, "params": params or {}})
        connection.request("POST", "/rpc", text, {"Authorization": f"Bearer {token}",
                                                  "Content-Type": "application/json"})
        answer = json.loads(connection.getresponse().read())
    finally:
        connection.close()
    if "error" in answer:
        raise AssertionError(f"{method}: {answer['error']}")
    return answer["result"]


def measurement(url, name, *, token=TOKEN):
    """A value of /metrics without labels, by its full name; None where there is none."""
    status, _, page = get(url + "metrics", token=token)
    assert status == 200, status
    for line in page.decode().splitlines():
        if line.startswith(f"{name} "):
            return float(line.split()[1])
    return None
