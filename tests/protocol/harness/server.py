"""Starts the real server and calls it over HTTP."""

import functools
import http.client
import json
import os
import queue
import re
import signal
import socket
import ssl
import subprocess
import tempfile
import threading
import time
import unittest

# Of everything that is waited for: more where a sanitizer makes the server slower.
TIME_FACTOR = float(os.environ.get("HELIOGRAPH_TEST_TIME_FACTOR", "1"))
START_TIMEOUT = 120 * TIME_FACTOR
UNKNOWN_METHOD = -32601
# Of the hybrid and of the path tracer: static views converge soon.
FEW_SAMPLES = {"accumulation": {"max_samples": 4}, "reference": {"samples": 2}}
CONVERGED_SAMPLES = (FEW_SAMPLES["accumulation"]["max_samples"] +
                     FEW_SAMPLES["reference"]["samples"])


class Server:
    """A running server on a free port of the loopback interface."""

    def __init__(self, *arguments, scenes=None, environment=None, certificate=None, early=False,
                 binary=None, new_session=False):
        """`certificate` is the one to trust where the server speaks TLS; `early`: not to wait for
        the first frame, only for the listener; `binary`: another program than that of all tests;
        `new_session`: alone in its session, as services are."""
        self.errors_seen = set()  # (method, code) of answers
        self.headers = {}  # that every request carries, such as a token's
        self.tls = ssl.create_default_context(cafile=certificate) if certificate else None
        self.log = tempfile.TemporaryFile(mode="w+")
        port = self._free_port() if early else 0
        command = [binary or os.environ["HELIOGRAPH_BINARY"], "serve", "--port", str(port),
                   "--width", "160", "--height", "90", *self._few_samples(),
                   "--scene-root", scenes or os.environ["HELIOGRAPH_SCENES"], *arguments]
        surroundings = {**os.environ, **(environment or {})}
        if os.environ.get("HELIOGRAPH_TEST_PRELOAD"):
            surroundings["LD_PRELOAD"] = os.environ["HELIOGRAPH_TEST_PRELOAD"]
        self.process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=self.log, text=True,
                                        env=surroundings, start_new_session=new_session)
        try:
            self.url = self._wait_for_listener(port) if early else self._wait_for_address()
        except Exception:
            self.process.kill()
            raise
        self.host, self.port = re.fullmatch(r"https?://(.+):(\d+)/", self.url).groups()
        self.port = int(self.port)

    @staticmethod
    def _few_samples():
        return [argument for group, members in FEW_SAMPLES.items()
                for name, value in members.items()
                for argument in ("--set", f"{group}.{name}={value}")]

    def _wait_for_address(self):
        lines = queue.Queue()
        reader = threading.Thread(target=lambda: lines.put(self.process.stdout.readline()),
                                  daemon=True)
        reader.start()
        line = lines.get(timeout=START_TIMEOUT)
        found = re.match(r"listening on (https?://\S+)", line)
        if not found:
            raise RuntimeError(f"the server said {line!r} and logged:\n{self.log_text()}")
        return found.group(1)

    @staticmethod
    def _free_port():
        with socket.socket() as probe:
            probe.bind(("127.0.0.1", 0))
            return probe.getsockname()[1]

    def _wait_for_listener(self, port):
        deadline = time.monotonic() + START_TIMEOUT
        while self.alive and time.monotonic() < deadline:
            with socket.socket() as probe:
                if probe.connect_ex(("127.0.0.1", port)) == 0:
                    break
            time.sleep(0.02)
        return f"http://127.0.0.1:{port}/"

    def log_text(self):
        self.log.seek(0)
        return self.log.read()

    def complaints(self):
        """What the sanitizers say that the program may have been built with."""
        text = self.log_text()
        found = re.search(r"^.*(runtime error: |ERROR: \w+Sanitizer|WARNING: ThreadSanitizer)", text,
                          re.MULTILINE)
        return text[found.start():] if found else ""

    @property
    def alive(self):
        return self.process.poll() is None

    @property
    def websocket_url(self):
        return f"{'wss' if self.tls else 'ws'}://{self.host}:{self.port}/ws"

    def memory_bytes(self):
        with open(f"/proc/{self.process.pid}/statm", encoding="ascii") as file:
            return int(file.read().split()[1]) * os.sysconf("SC_PAGESIZE")

    def cpu_seconds(self):
        with open(f"/proc/{self.process.pid}/stat", encoding="ascii") as file:
            fields = file.read().rsplit(")", 1)[1].split()
        return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")

    def request(self, method, path, body=None, headers=None, timeout=60):
        """One HTTP exchange: status, headers with lower-case names, body."""
        connection = (
            http.client.HTTPSConnection(self.host, self.port, timeout=timeout, context=self.tls)
            if self.tls else http.client.HTTPConnection(self.host, self.port, timeout=timeout))
        try:
            connection.request(method, path, body, {**self.headers, **(headers or {})})
            response = connection.getresponse()
            names = {name.lower(): value for name, value in response.getheaders()}
            return response.status, names, response.read()
        finally:
            connection.close()

    def get(self, path, **headers):
        return self.request("GET", path, headers=headers)

    def post_rpc(self, payload, session=None):
        """Sends any JSON value, or bytes as they are; returns the status and the parsed answer."""
        path = "/rpc" + (f"?session={session}" if session else "")
        body = payload if isinstance(payload, bytes) else json.dumps(payload).encode()
        status, _, answer = self.request("POST", path, body,
                                         {"Content-Type": "application/json"}, timeout=120)
        return status, json.loads(answer) if answer else None

    def ask(self, method, params=None, session=None):
        """The complete JSON-RPC response, with a result or an error."""
        call = {"jsonrpc": "2.0", "id": 1, "method": method, "params": params or {}}
        return self.seen(method, self.post_rpc(call, session)[1])

    def seen(self, method, answer):
        """Records the errors that a method returned."""
        if "error" in answer and answer["error"]["code"] != UNKNOWN_METHOD:
            self.errors_seen.add((method, answer["error"]["code"]))
        return answer

    def call(self, method, params=None, session=None):
        answer = self.ask(method, params, session)
        if "error" in answer:
            raise AssertionError(f"{method}: {answer['error']}")
        return answer["result"]

    def wait_for(self, condition, what, timeout=20, pause=0.05):
        deadline = time.monotonic() + timeout * TIME_FACTOR
        while not condition():
            if time.monotonic() > deadline:
                raise AssertionError(f"{what} did not happen in {timeout} s:\n{self.log_text()}")
            time.sleep(pause)

    def stop(self, number=signal.SIGTERM):
        """Ends the server and returns its exit code."""
        if self.alive:
            self.process.send_signal(number)
        return self.wait()

    def wait(self):
        """Waits for the server to end and returns its exit code; None if it has to be killed."""
        try:
            return self.process.wait(timeout=15 * TIME_FACTOR)
        except subprocess.TimeoutExpired:
            self.process.kill()
            self.process.wait()
            return None
        finally:
            self.process.stdout.close()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.stop()
        complaints = self.complaints()
        self.log.close()
        if complaints:
            raise AssertionError(complaints)


@functools.cache
def declared_errors():
    """(method, code) for everything that the protocol's description says a method may answer."""
    document = json.loads(subprocess.run([os.environ["HELIOGRAPH_BINARY"], "schema"], check=True,
                                         stdout=subprocess.PIPE).stdout)["openrpc"]
    codes = {name: error["code"] for name, error in document["components"]["errors"].items()}
    return {(method["name"], codes[error["$ref"].rsplit("/", 1)[1]])
            for method in document["methods"] for error in method["errors"]}


class ServerTestCase(unittest.IsolatedAsyncioTestCase):
    """Tests that share one server, which must survive each of them."""

    arguments = ()
    folder = None  # a temporary one of the class

    @classmethod
    def setUpClass(cls):
        cls.server = Server(*cls.arguments)

    @classmethod
    def tearDownClass(cls):
        with cls.server:
            undeclared = cls.server.errors_seen - declared_errors()
        if cls.folder:
            cls.folder.cleanup()
        if undeclared:
            raise AssertionError(f"rpc.discover does not tell of {sorted(undeclared)}")

    def setUp(self):
        self.reset()

    def tearDown(self):
        self.assertTrue(self.server.alive, "the server died:\n" + self.server.log_text())

    def reset(self):
        """The state every test begins with."""
        if self.server.call("scene.list")["current"] != "mirror":
            self.server.call("scene.load", {"name": "mirror"})
        defaults = {group: None for group in self.server.call("settings.get")["settings"]}
        self.server.call("settings.patch", {"patch": defaults})
        self.server.call("settings.patch", {"patch": FEW_SAMPLES})
        self.server.call("stream.configure", {"width": 160, "height": 90})
        self.server.call("camera.fit")

    def assert_error(self, answer, code, *, path=None, limit=None):
        self.assertIn("error", answer)
        error = answer["error"]
        self.assertEqual(error["code"], code, error)
        self.assertTrue(error["message"])
        if path is not None:
            self.assertEqual(error["data"]["path"], path, error)
        if limit is not None:
            self.assertIn(limit, error["data"].get("limit", ""), error)
