"""Read-only and control tokens, guessing of tokens, proxies, embedding."""

import json
import os
import tempfile
import time
import unittest

from harness.raw_socket import TEXT, RawSocket, frame
from harness.server import Server, ServerTestCase

CONTROL, VIEW, EXTRA = "steering-0123456789", "watching-0123456789", "watching-too-98765432"
COMMANDS = """
    scene.load scene.unload scene.cancel camera.set camera.fit camera.orbit
    settings.patch settings.preset animation.play animation.pause animation.seek animation.rate
    session.create session.close session.control materials.patch lights.patch environment.set
    lights.add lights.remove edits.apply section.set
    frame.step frame.run reference.start reference.stop job.create job.cancel
    measurements.add measurements.remove measurements.clear measurements.unit
    annotations.add annotations.edit annotations.remove annotations.clear
    """.split()
PERSONAL = ("stream.pause stream.resume stream.ack stream.configure stats.subscribe pointer.set "
            "viewer.follow").split()


def bearer(token):
    return {"Authorization": "Bearer " + token}


class Roles(ServerTestCase):
    @classmethod
    def setUpClass(cls):
        cls.file = tempfile.NamedTemporaryFile("w", suffix=".tokens")
        cls.file.write(f"# roles\n\nview {EXTRA}\n")
        cls.file.flush()
        cls.arguments = ("--token", CONTROL, "--view-token", VIEW, "--token-file", cls.file.name,
                         "--log-level", "debug", "--log-format", "json")
        super().setUpClass()

    @classmethod
    def tearDownClass(cls):
        super().tearDownClass()
        cls.file.close()

    def setUp(self):
        pass

    def over_http(self, token, method, params=None):
        body = json.dumps({"jsonrpc": "2.0", "id": 1, "method": method, "params": params or {}})
        status, _, answer = self.server.request("POST", "/rpc", body, bearer(token))
        self.assertEqual(status, 200)
        return json.loads(answer)

    def over_websocket(self, token, *calls):
        with RawSocket(self.server) as raw:
            self.assertEqual(raw.upgrade(**bearer(token))[0], 101)
            answers = []
            for number, (method, params) in enumerate((("hello", {}), *calls)):
                call = {"jsonrpc": "2.0", "id": number, "method": method, "params": params}
                raw.send(frame(TEXT, json.dumps(call).encode()))
                while True:
                    opcode, payload = raw.read_frame()
                    if opcode == TEXT and json.loads(payload).get("id") == number:
                        answers.append(json.loads(payload))
                        break
            return answers[1:]

    def test_commands_are_refused_to_read_only_viewers(self):
        document = self.over_http(CONTROL, "rpc.discover")["result"]
        methods = {method["name"]: method for method in document["methods"]}
        self.assertEqual(set(COMMANDS + PERSONAL) - set(methods), set(), "names of no method")
        for method in (methods[name] for name in COMMANDS):
            params = {}
            if method.get("examples"):
                params = {one["name"]: one["value"] for one in method["examples"][0]["params"]}
            for token in (VIEW, EXTRA):
                answer = self.over_http(token, method["name"], params)
                self.assert_error(answer, -32001)
            self.assert_error(self.over_websocket(VIEW, (method["name"], params))[0], -32001)

    def test_the_contract_marks_read_only_methods(self):
        document = self.over_http(CONTROL, "rpc.discover")["result"]
        methods = {method["name"]: method for method in document["methods"]}
        for name, method in methods.items():
            controls = method["x-needs-control"] or name in COMMANDS
            self.assertNotEqual(method["x-read-only"], controls, name)
        for name in PERSONAL:
            self.assertFalse(methods[name]["x-needs-control"], name)
            self.assertTrue(methods[name]["x-may-be-notification"], name)

    def test_hello_returns_the_role(self):
        for token, role in ((CONTROL, "control"), (VIEW, "view"), (EXTRA, "view")):
            self.assertEqual(self.over_http(token, "hello")["result"]["role"], role)
            answer, = self.over_websocket(token, ("hello", {}))
            self.assertEqual(answer["result"]["role"], role)

    def test_read_only_viewers_control_their_own_stream(self):
        paused, resumed = self.over_websocket(VIEW, ("stream.pause", {}), ("stream.resume", {}))
        self.assertTrue(paused["result"]["paused"])
        self.assertFalse(resumed["result"]["paused"])

    def test_queries_are_allowed_to_read_only_viewers(self):
        for method in ("scene.list", "scene.info", "camera.get", "settings.get", "frame.buffers",
                       "rpc.discover", "frame.capture"):
            self.assertIn("result", self.over_http(VIEW, method), method)
        configured, stats = self.over_websocket(
            VIEW, ("stream.configure", {"quality": 60, "max_fps": 5}),
            ("stats.subscribe", {"interval_ms": 500}))
        self.assertIn("result", configured)
        self.assertIn("result", stats)
        self.assertEqual(self.server.get("/api/v1/sessions/main/frame.jpg", **bearer(VIEW))[0], 200)

    def test_a_read_only_viewer_cannot_choose_the_shared_frame_size(self):
        answer, = self.over_websocket(VIEW, ("stream.configure", {"width": 320, "height": 200}))
        self.assert_error(answer, -32001)
        answer = self.over_http(VIEW, "stream.configure", {"width": 320})
        self.assert_error(answer, -32001, path="width")
        answer = self.over_http(VIEW, "stream.configure", {"height": 50})
        self.assert_error(answer, -32001, path="height")
        answer, = self.over_websocket(CONTROL, ("stream.configure", {"width": 160, "height": 90}))
        self.assertIn("result", answer)

    def test_a_batch_is_checked_call_by_call(self):
        batch = [{"jsonrpc": "2.0", "id": 1, "method": "camera.get"},
                 {"jsonrpc": "2.0", "id": 2, "method": "camera.set", "params": {"eye": [1, 1, 1]}},
                 {"jsonrpc": "2.0", "method": "camera.set", "params": {"eye": [9, 9, 9]}}]
        status, _, answer = self.server.request("POST", "/rpc", json.dumps(batch), bearer(VIEW))
        first, second = json.loads(answer)
        self.assertIn("result", first)
        self.assertEqual(second["error"]["code"], -32001)
        self.assertNotEqual(self.over_http(VIEW, "camera.get")["result"]["eye"], [9, 9, 9])

    def test_the_log_names_viewer_and_session(self):
        """Every line about one session or one viewer names it in members of its own."""
        self.over_websocket(CONTROL, ("session.create", {"name": "logged", "scene": "furnace",
                                                         "width": 16, "height": 16}),
                            ("session.close", {"session": "logged"}))
        with RawSocket(self.server) as raw:
            raw.send(b"GET /api/v1/sessions/main/stream.mjpg HTTP/1.1\r\nHost: localhost\r\n"
                     b"Authorization: Bearer " + VIEW.encode() + b"\r\n\r\n")
            self.server.wait_for(lambda: "over HTTP" in self.server.log_text(), "images")
        self.server.wait_for(lambda: "the session ended" in self.server.log_text(), "the end")
        lines = [json.loads(line) for line in self.server.log_text().splitlines()]

        def members(part):
            found = [line for line in lines if part in line["message"]]
            self.assertTrue(found, part)
            return [{name for name in ("session", "viewer", "client") if line.get(name)}
                    for line in found]

        for part in ("the session was opened", "the session ended", " loaded in "):
            for received in members(part):
                self.assertIn("session", received, part)
        for part in ("a viewer connected", "a viewer left", "a viewer streams images over HTTP"):
            for received in members(part):
                self.assertEqual(received, {"session", "viewer", "client"}, part)
        self.assertIn("logged", {line.get("session") for line in lines})

    def test_the_log_contains_no_token(self):
        self.server.get("/?token=" + CONTROL)
        self.server.get("/?token=" + CONTROL[:-1])
        self.server.get("/metrics", **bearer("guess-work-guess"))
        self.over_websocket(VIEW, ("camera.get", {}))
        log = self.server.log_text()
        for secret in (CONTROL, VIEW, EXTRA, CONTROL[:-1], "guess-work-guess"):
            self.assertNotIn(secret, log)
        for line in log.splitlines():
            self.assertIn("message", json.loads(line), line)


class TokenGuessing(ServerTestCase):
    arguments = ("--token", CONTROL, "--trust-proxy", "127.0.0.1")

    def setUp(self):
        pass

    def ask(self, token, client):
        return self.server.get("/metrics", **bearer(token), **{"X-Forwarded-For": client})

    def guess_until_refused(self, client):
        """How many guesses were listened to; one more is, every two seconds."""
        for count in range(200):
            status = self.ask(f"guess-{count:08}", client)[0]
            if status == 429:
                return count
            self.assertEqual(status, 401)
        self.fail("guessing goes on and on")

    def test_guessing_is_blocked_per_client(self):
        begin = time.monotonic()
        listened_to = self.guess_until_refused("198.51.100.1")
        self.assertGreaterEqual(listened_to, 15)
        self.assertLessEqual(listened_to, 21 + 0.5 * (time.monotonic() - begin))
        status, headers, _ = self.ask(CONTROL, "198.51.100.1")
        self.assertEqual(status, 429, "the right one, too, or guessing would find it")
        self.assertGreater(int(headers["retry-after"]), 0)
        self.assertEqual(self.ask(CONTROL, "198.51.100.2")[0], 200)
        self.assertEqual(self.server.get("/health/ready")[0], 200)
        with RawSocket(self.server) as raw:
            self.guess_until_refused("198.51.100.1")
            status, _ = raw.upgrade(**bearer(CONTROL), X_Forwarded_For="198.51.100.1")
            self.assertEqual(status, 429)

        def listened_to_again():
            return self.ask(CONTROL, "198.51.100.1")[0] == 200
        self.server.wait_for(listened_to_again, "forgiveness", timeout=10)

    def test_token_comparison_takes_constant_time(self):
        """Medians of whole answers; a comparison that stops early is far below this noise, so this
        only finds gross mistakes. That digests are compared is for the reader of the code."""
        def median(token, client):
            times = []
            for _ in range(9):
                begin = time.perf_counter()
                self.ask(token, client)
                times.append(time.perf_counter() - begin)
            return sorted(times)[4]
        near, far = median(CONTROL[:-1] + "x", "203.0.113.1"), median("y" * 19, "203.0.113.2")
        self.assertLess(abs(near - far), 0.05)


class Proxies(unittest.TestCase):
    def test_headers_of_untrusted_proxies_are_ignored(self):
        with Server("--token", CONTROL) as server:
            statuses = [server.get("/metrics", **bearer(f"guess-{i:08}"),
                                   **{"X-Forwarded-For": f"198.51.100.{i}"})[0] for i in range(30)]
            self.assertEqual(statuses[-1], 429, "one client, whatever it writes")
            cookie = server.get("/?token=" + CONTROL, **{"X-Forwarded-Proto": "https"})
            self.assertEqual(cookie[0], 429)

    def test_hosts_origins_and_cookies_behind_a_proxy(self):
        with Server("--trust-proxy", "127.0.0.0/8", "--allow-host", "viewer.example",
                    "--token", CONTROL, "--frame-ancestors", "https://portal.example",
                    "--frame-ancestors", "self") as server:
            forwarded = {"Host": "viewer.example", "X-Forwarded-Proto": "https",
                         "X-Forwarded-For": "198.51.100.7"}
            status, headers, _ = server.get("/?token=" + CONTROL, **forwarded)
            self.assertEqual(status, 303)
            self.assertIn("; Secure", headers["set-cookie"])
            self.assertIn("SameSite=None; Partitioned", headers["set-cookie"])
            policy = headers["content-security-policy"]
            self.assertIn("frame-ancestors https://portal.example 'self'", policy)
            with RawSocket(server) as raw:
                status, _ = raw.upgrade(Host="viewer.example", Origin="https://viewer.example",
                                        X_Forwarded_Proto="https", **bearer(CONTROL))
                self.assertEqual(status, 101)
            plain = server.get("/?token=" + CONTROL)[1]["set-cookie"]
            self.assertNotIn("Secure", plain)
            self.assertIn("SameSite=Strict", plain)

    def test_allowed_hosts_must_match_exactly(self):
        with Server("--allow-host", "viewer.example") as server:
            for host, expected in (("viewer.example", 200), ("VIEWER.example:443", 200),
                                   ("viewer.example.evil", 403), ("x.viewer.example", 403)):
                self.assertEqual(server.get("/", Host=host)[0], expected, host)


class WrongOptions(unittest.TestCase):
    def fails(self, *arguments, saying):
        with self.assertRaisesRegex(RuntimeError, saying):
            Server(*arguments)

    def test_errors_name_the_option(self):
        self.fails("--view-token", "short", saying="8 characters")
        self.fails("--token", CONTROL, "--view-token", CONTROL, saying="the same")
        self.fails("--allow-host", "https://x", saying="host name")
        self.fails("--trust-proxy", "10.0.0.0/99", saying="10.0.0.0/8")
        self.fails("--frame-ancestors", "*; script-src *", saying="embed")
        self.fails("--metrics-listen", "9464", saying="127.0.0.1:9464")
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "tokens")
            with open(path, "w", encoding="ascii") as file:
                file.write("control right-1234\nadmin other-12345678\n")
            with self.assertRaises(RuntimeError) as caught:
                Server("--token-file", path)
            self.assertIn("tokens:2", str(caught.exception))
            self.assertNotIn("other-12345678", str(caught.exception))
