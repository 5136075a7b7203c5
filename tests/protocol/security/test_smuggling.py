"""Ambiguous requests: on a connection that a next request follows on, and behind the proxies of deploy/balancer,
whose connections to the server carry the requests of all clients. No answer to another client may change, and the
server may see as many requests as were forwarded."""

import contextlib
import http.client
import json
import re
import socket
import tempfile
import time
import unittest

from harness.ambiguous import HOST, ambiguous_requests
from harness.http_reading import disagreement, requests_of, responses_of
from harness.proxies import Haproxy, Nginx, installed
from harness.recorder import Recorder
from harness.server import TIME_FACTOR, Server

ATTACKS = (("POST", "/rpc"), ("GET", "/health/live"))
ANSWERED_WITHIN = 0.3  # seconds that an attacker waits, where nothing may come
# The attacker's own next request.
LAST = f"GET /health/live HTTP/1.1\r\n{HOST}Connection: close\r\n\r\n".encode()
SAME_IN_A_ROW = 4  # counts, since checks of health may be on their way


def every_attack():
    found = []
    for method, target in ATTACKS:
        found += ambiguous_requests(method, target, len(found))
    return found


def call(number):
    return json.dumps({"jsonrpc": "2.0", "id": f"other {number}", "method": "hello", "params": {}})


class Behind:
    """What the tests of both proxies share; `cls.proxy` stands before `cls.recorder`."""

    make_proxy = None

    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.folder.cleanup)
        cls.server = cls.enterClassContext(Server("--trust-proxy", "127.0.0.1"))
        cls.reads = 0  # of metrics, which are requests, too
        cls.recorder = Recorder(cls.server.port)
        cls.addClassCleanup(cls.recorder.stop)
        cls.proxy = cls.make_proxy(cls.folder.name, cls.recorder.port)
        cls.addClassCleanup(cls.proxy.stop)

    def setUp(self):
        self.others = [http.client.HTTPConnection("127.0.0.1", self.proxy.port, timeout=20) for _ in range(2)]
        for other in self.others:
            self.addCleanup(other.close)

    def test_every_client_gets_its_own_answer(self):
        for number, (name, text) in enumerate(every_attack()):
            with self.subTest(name):
                self.attack(text)
                for other in self.others:
                    self.ask_as(other, number)
        self.assert_all_agree()
        self.assertGreater(self.shared_passages(), 0, "no connection carried attacks and other requests")

    def test_attackers_among_themselves_get_no_more_answers_than_the_proxy_forwarded(self):
        """All ambiguous requests at the same time, each on a connection of its own."""
        attackers = []
        for _, text in every_attack():
            attacker = socket.create_connection(("127.0.0.1", self.proxy.port))
            self.addCleanup(attacker.close)
            attacker.sendall(text + LAST)
            attackers.append(attacker)
        for number in range(20):
            self.ask_as(self.others[0], number)
        for attacker in attackers:
            self.read_all(attacker)
            attacker.close()
        self.assert_all_agree()

    def attack(self, text):
        with socket.create_connection(("127.0.0.1", self.proxy.port)) as raw:
            raw.sendall(text + LAST)
            self.read_all(raw)

    def read_all(self, raw):
        """Until the proxy closes the connection, or nothing comes and the server owes no response. Proxies give up
        what they have forwarded for clients that leave before, and do not count it."""
        raw.settimeout(ANSWERED_WITHIN)
        deadline = time.monotonic() + 10 * TIME_FACTOR
        connected, owed = True, True
        while connected and owed and time.monotonic() < deadline:
            try:
                connected = bool(raw.recv(65536))
            except TimeoutError:
                owed = bool(self.disagreements())
            except OSError:
                connected = False

    def ask_as(self, other, number):
        """A client that sends two requests on its connection to the proxy."""
        mark = {"X-Other": str(number)}
        other.request("GET", "/health/live", headers=mark)
        response = other.getresponse()
        self.assertEqual((response.status, response.read()), (200, b"live\n"))
        other.request("POST", "/rpc", call(number), {"Content-Type": "application/json", **mark})
        response = other.getresponse()
        answer = response.read()
        self.assertEqual((response.status, json.loads(answer).get("id")), (200, f"other {number}"), answer)

    def shared_passages(self):
        """Connections to the server on which another client's request followed an attack."""
        shared = 0
        for passage in self.recorder.passages:
            kinds = "".join("a" if "x-case" in (request.fields or {}) else "o"
                            for request in requests_of(passage.sent))
            shared += "ao" in kinds
        return shared

    def assert_all_agree(self):
        """The server, an independent reader of the same bytes, and the proxy count the same requests."""
        same, deadline = 0, time.monotonic() + 30 * TIME_FACTOR
        while same < SAME_IN_A_ROW and time.monotonic() < deadline:
            counts, disagreements = self.counts(), self.disagreements()
            same = same + 1 if len(set(counts.values())) == 1 and not disagreements else 0
            time.sleep(0.1)
        self.assertEqual(same, SAME_IN_A_ROW, (counts, disagreements))

    def disagreements(self):
        """A check of health that is on its way is one, for as long as that."""
        return [found for passage in list(self.recorder.passages)
                if (found := disagreement(passage.sent, passage.answered))]

    def counts(self):
        """Checks of health are not part of what proxies tell."""
        requests = [request for passage in list(self.recorder.passages) for request in requests_of(passage.sent)]
        checks = sum(request.target == "/health/ready" for request in requests)
        return {"server": self.responses_of_server(), "bytes": len(requests), "proxy": self.proxy.answers() + checks}

    def responses_of_server(self):
        page = self.server.get("/metrics")[2].decode()
        found = re.findall(r'^heliograph_http_responses_total\{status="\d+"\} (\d+)$', page, re.MULTILINE)
        type(self).reads += 1
        return sum(int(count) for count in found) - (self.reads - 1)


@unittest.skipUnless(installed("nginx"), "nginx is not installed")
class BehindNginx(Behind, unittest.TestCase):
    make_proxy = Nginx


@unittest.skipUnless(installed("haproxy"), "haproxy is not installed")
class BehindHaproxy(Behind, unittest.TestCase):
    make_proxy = Haproxy


class OnOneConnection(unittest.TestCase):
    """As behind a proxy that forwards every byte."""

    @classmethod
    def setUpClass(cls):
        cls.server = cls.enterClassContext(Server())

    def test_ambiguous_requests_are_refused_and_nothing_behind_them_is_answered(self):
        body = call("behind")
        behind = (f"POST /rpc HTTP/1.1\r\n{HOST}Content-Type: application/json\r\nConnection: close\r\n"
                  f"Content-Length: {len(body)}\r\n\r\n{body}").encode()
        for name, text in every_attack():
            with self.subTest(name):
                answered = self.answers_to(text + behind)
                self.assertEqual(disagreement(text + behind, answered), "")
                requests = requests_of(text + behind)
                if not requests[-1].refused and requests[-1].target == "/rpc" and len(requests) > 1:
                    last = responses_of(answered, [request.method for request in requests])[-1]
                    self.assertEqual(json.loads(last.body)["id"], "other behind")

    def answers_to(self, text):
        """All that comes until the server closes the connection."""
        received = b""
        with socket.create_connection((self.server.host, self.server.port), timeout=5 * TIME_FACTOR) as raw:
            with contextlib.suppress(ConnectionError):
                raw.sendall(text)
                raw.shutdown(socket.SHUT_WR)
                while data := raw.recv(65536):
                    received += data
        return received
