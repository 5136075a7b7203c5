"""Single servers in hardened containers, and HTTP requests to them."""

import http.client
import json
import os
import socket
import ssl
import time
import urllib.parse

from .commands import program, run
from .files import text_of
from .images import SERVER

TOKEN = "deployment-test-token"
HARDENED = ("--read-only", "--cap-drop", "ALL", "--security-opt", "no-new-privileges",
            "--tmpfs", "/tmp:size=64m,mode=1777,noexec,nosuid,nodev", "--pids-limit", "256")


class Container:
    """A running server; `remove` ends it."""

    def __init__(self, machine, name, *options, port=8080, serve=()):
        self.machine, self.name = machine, name
        self.url = f"http://{machine.address}:{port}/"
        self.started_at = time.monotonic()
        machine.docker("run", "--detach", "--name", name, *HARDENED, "--publish", f"{port}:8080",
                       "--env", f"HELIOGRAPH_TOKEN={TOKEN}", *options, SERVER, "serve", *serve)

    def wait_healthy(self, timeout=300):
        """Returns the seconds that it took."""
        while self.machine.docker("inspect", "--format", "{{.State.Health.Status}}",
                                  self.name) != "healthy":
            if time.monotonic() - self.started_at > timeout or not self.running():
                raise AssertionError(f"{self.name} is not healthy:\n{self.log()}")
            time.sleep(0.1)
        return time.monotonic() - self.started_at

    def wait_ready(self, timeout=300):
        """Waits until it is ready for viewers, which is after its first frame. Returns the seconds
        of processor time until then: unlike wall clock time they do not depend on other load of
        the machine."""
        while not self._is_ready():
            if time.monotonic() - self.started_at > timeout or not self.running():
                raise AssertionError(f"{self.name} is not ready:\n{self.log()}")
            time.sleep(0.02)
        return self.processor_seconds()

    def _is_ready(self):
        try:
            return self.get("health/ready", timeout=5)[0] == 200
        except OSError:
            return False  # not listening yet

    def processor_seconds(self):
        """The processor time of all its threads so far."""
        process = self.machine.inspect(self.name, "{{.State.Pid}}")
        with open(f"/proc/{process}/stat", encoding="ascii") as file:
            fields = file.read().rsplit(")", 1)[1].split()
        return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")

    def threads(self):
        """The name of each thread, without trailing numbers."""
        tasks = f"/proc/{self.machine.inspect(self.name, '{{.State.Pid}}')}/task"
        return [text_of(f"{tasks}/{task}/comm").strip().split("-")[0] for task in os.listdir(tasks)]

    def memory_bytes(self):
        """The memory of its control group, without reclaimable file cache."""
        identity = self.machine.inspect(self.name, '"{{.Id}}"')
        for folder, usage in (("/sys/fs/cgroup/memory/docker", "memory.usage_in_bytes"),
                              ("/sys/fs/cgroup/docker", "memory.current")):
            group = os.path.join(folder, identity)
            if os.path.isdir(group):
                held = int(text_of(os.path.join(group, usage)))
                counts = dict(line.split() for line in
                              text_of(os.path.join(group, "memory.stat")).splitlines())
                return held - int(counts.get("total_inactive_file", counts["inactive_file"]))
        raise AssertionError(f"no control group of {identity}")

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


def make_certificate(path, address):
    """A self-signed certificate with its key in the same file, readable by every user."""
    run(program("openssl"), "req", "-x509", "-newkey", "ec", "-pkeyopt",
        "ec_paramgen_curve:prime256v1", "-nodes", "-days", "2", "-subj", "/CN=heliograph", "-addext",
        f"subjectAltName=IP:{address}", "-keyout", path, "-out", f"{path}.certificate")
    with open(path, "a", encoding="ascii") as file:
        file.write(text_of(f"{path}.certificate"))
    os.chmod(path, 0o644)


def free_port():
    """A port that is free on this machine's loopback interface now."""
    with socket.create_server(("127.0.0.1", 0)) as server:
        return server.getsockname()[1]


def get(url, *, token=TOKEN, headers=None, timeout=60, certificate=None):
    """Status, headers and body of one request on its own connection; with TLS if the file with the
    server's certificate is given."""
    address = urllib.parse.urlsplit(url)
    if certificate:
        connection = http.client.HTTPSConnection(
            address.hostname, address.port, timeout=timeout,
            context=ssl.create_default_context(cafile=certificate))
    else:
        connection = http.client.HTTPConnection(address.hostname, address.port, timeout=timeout)
    try:
        path = address.path + ("?" + address.query if address.query else "")
        connection.request("GET", path, headers={"Authorization": f"Bearer {token}",
                                                 **(headers or {})})
        answer = connection.getresponse()
        return answer.status, _by_name(answer.getheaders()), answer.read()
    finally:
        connection.close()


def _by_name(headers):
    """Headers by name in canonical case; repeated headers have one line each."""
    found = {}
    for name, value in headers:
        name = name.title()
        found[name] = f"{found[name]}\n{value}" if name in found else value
    return found


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
    """A metric without labels, by its full name; None if it does not exist."""
    status, _, page = get(url + "metrics", token=token)
    assert status == 200, status
    for line in page.decode().splitlines():
        if line.startswith(f"{name} "):
            return float(line.split()[1])
    return None
