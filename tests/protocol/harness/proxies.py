"""The proxies of deploy/balancer with their files as they are, but for addresses."""

import csv
import http.client
import os
import re
import shutil
import socket
import struct
import subprocess
import threading
import time

ROOT = os.path.normpath(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", ".."))
FOLDER = os.path.join(ROOT, "deploy", "balancer")
PLACES = ("client_body", "proxy", "fastcgi", "uwsgi", "scgi")


def installed(name):
    return shutil.which(name, path=os.environ["PATH"] + ":/usr/sbin:/sbin")


def free_port():
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


def changed(name, *changes):
    """The text of a file with each pair of texts replaced as often as it says."""
    with open(os.path.join(FOLDER, name), encoding="utf-8") as file:
        text = file.read()
    for written, instead, times in changes:
        assert text.count(written) == times, f"{written} is {text.count(written)} times in {name}"
        text = text.replace(written, instead)
    return text


class Proxy:
    """Listens on `port` of the loopback interface, in front of a server on `upstream`."""

    name = None

    def start(self, folder, *command, environment=None):
        self.log = os.path.join(folder, f"{self.name}.log")
        with open(self.log, "w", encoding="utf-8") as log:
            self.process = subprocess.Popen(  # pylint: disable=consider-using-with
                command, stdout=log, stderr=log, env={**os.environ, **(environment or {})})
        deadline = time.monotonic() + 20
        while self.process.poll() is None and time.monotonic() < deadline:
            if self.is_ready():
                return
            time.sleep(0.05)
        self.stop()
        with open(self.log, encoding="utf-8") as log:
            raise AssertionError(f"{self.name} does not listen: {log.read()}")

    def is_ready(self):
        """Whether the server answers through it."""
        connection = http.client.HTTPConnection("127.0.0.1", self.port, timeout=5)
        try:
            connection.request("GET", "/health/live")
            return connection.getresponse().status == 200
        except OSError:
            return False
        finally:
            connection.close()

    def stop(self):
        if self.process.poll() is None:
            self.process.terminate()
        try:
            self.process.wait(20)
        except subprocess.TimeoutExpired:
            self.process.kill()
            self.process.wait()


class Nginx(Proxy):
    name = "nginx"

    def __init__(self, folder, upstream):
        self.port = free_port()
        self.access = os.path.join(folder, "access.log")
        site = changed("nginx.conf", ("listen 80;", f"listen 127.0.0.1:{self.port};", 1),
                       ("server 127.0.0.1:8080 ", f"server 127.0.0.1:{upstream} ", 1))
        with open(os.path.join(folder, "site.conf"), "w", encoding="utf-8") as file:
            file.write(site)
        temporary = "".join(f"{place}_temp_path {folder}/{place};\n" for place in PLACES)
        with open(os.path.join(folder, "nginx.conf"), "w", encoding="utf-8") as file:
            file.write(f"daemon off;\npid {folder}/pid;\nevents {{}}\n"
                       f"http {{\nlog_format upstream '$upstream_status';\naccess_log {self.access} upstream;\n"
                       f"{temporary}include {folder}/site.conf;\n}}\n")
        self.start(folder, installed("nginx"), "-p", folder, "-e", "stderr", "-c", f"{folder}/nginx.conf")

    def answers(self):
        """How many responses it has had from the server. It makes 499 and 502 itself."""
        with open(self.access, encoding="utf-8") as file:
            return sum(status not in ("499", "502") for status in re.findall(r"\b\d{3}\b", file.read()))


class NameServer:
    """Gives every name the address 127.0.0.1, RFC 1035 section 4."""

    def __init__(self):
        self.socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.socket.bind(("127.0.0.1", 0))
        self.port = self.socket.getsockname()[1]
        threading.Thread(target=self._answer, daemon=True).start()

    def _answer(self):
        while True:
            try:
                asked, sender = self.socket.recvfrom(4096)
            except OSError:
                return
            end = asked.index(b"\0", 12) + 5
            kind, = struct.unpack(">H", asked[end - 4:end - 2])
            found = b"\xc0\x0c" + struct.pack(">HHIH", 1, 1, 60, 4) + bytes((127, 0, 0, 1)) if kind == 1 else b""
            self.socket.sendto(asked[:2] + struct.pack(">HHHHH", 0x8180, 1, bool(found), 0, 0) +
                               asked[12:end] + found, sender)

    def stop(self):
        self.socket.close()


class Haproxy(Proxy):
    name = "haproxy"
    backends = ("by_viewer", "by_session", "calls")

    def __init__(self, folder, upstream):
        self.port, self.measurements = free_port(), free_port()
        self.names = NameServer()
        file = os.path.join(folder, "haproxy.cfg")
        changes = [("bind :8080\n", f"bind 127.0.0.1:{self.port}\n", 1),
                   ("bind :8404\n", f"bind 127.0.0.1:{self.measurements}\n", 1),
                   ('"${HELIOGRAPH_NODES}":8080', f'"${{HELIOGRAPH_NODES}}":{upstream}', 3),
                   ("  parse-resolv-conf\n", f"  nameserver only 127.0.0.1:{self.names.port}\n", 1),
                   ("abns@heliograph-nodes", f"abns@heliograph-{self.port}", 2)]
        if self.release() < 3:
            changes.append((" hash-key addr", "", 2))  # of several nodes, where there is one here
        with open(file, "w", encoding="utf-8") as configuration:
            configuration.write(changed("haproxy.cfg", *changes))
        self.start(folder, installed("haproxy"), "-db", "-f", file, environment={
            "HELIOGRAPH_NODES": "node.example", "HELIOGRAPH_COOKIE_KEY": "test",
            "HELIOGRAPH_OUTER_PROXIES": "", "HELIOGRAPH_CERTIFICATE": ""})

    @staticmethod
    def release():
        told = subprocess.run([installed("haproxy"), "-v"], check=True, capture_output=True, text=True).stdout
        return int(re.search(r"version (\d+)", told)[1])

    def answers(self):
        """How many final responses it has had from the server, without checks of health."""
        connection = http.client.HTTPConnection("127.0.0.1", self.measurements, timeout=10)
        try:
            connection.request("GET", "/;csv")
            page = connection.getresponse().read().decode()
        finally:
            connection.close()
        rows = csv.DictReader(page.removeprefix("# ").splitlines())
        return sum(int(row[f"hrsp_{kind}"] or 0) for row in rows
                   if row["pxname"] in self.backends and row["svname"].startswith("node")
                   for kind in ("2xx", "3xx", "4xx", "5xx", "other"))

    def stop(self):
        super().stop()
        self.names.stop()
