"""Access control: origins, host names, tokens, cookies, limits."""

import base64

from harness.raw_socket import RawSocket
from harness.server import Server, ServerTestCase


class Loopback(ServerTestCase):
    def upgrade(self, **headers):
        with RawSocket(self.server) as raw:
            return raw.upgrade(**headers)

    def own(self):
        return f"{self.server.host}:{self.server.port}"

    def test_the_subprotocol_is_required_and_returned(self):
        for offered in (None, "heliograph.v2", "chat, superchat", "heliograph.v10",
                        "Heliograph.v1"):
            status, text = self.upgrade(Sec_WebSocket_Protocol=offered)
            self.assertEqual(status, 400, offered)
            self.assertIn("heliograph.v1", text)
        status, text = self.upgrade(Sec_WebSocket_Protocol="other, heliograph.v1")
        self.assertEqual(status, 101)
        self.assertIn("sec-websocket-protocol: heliograph.v1\r\n", text.lower())

    def test_pages_of_other_sites_are_refused(self):
        own = self.own()
        for origin in ("http://evil.example", "null", f"http://{own}.evil.example",
                       f"http://evil.example/{own}", "http://localhost", f"http://{own}@evil",
                       f"http://{self.server.host}:{self.server.port + 1}", f"ftp://{own}", "",
                       f"http://{own}, http://evil.example"):
            status, _ = self.upgrade(Origin=origin)
            self.assertEqual(status, 403, origin)
            status, _, _ = self.server.request(
                "POST", "/rpc", b'{"jsonrpc":"2.0","id":1,"method":"hello"}', {"Origin": origin})
            self.assertEqual(status, 403, origin)
            for path in ("/", "/metrics", "/api/v1/sessions/main/frame.png"):
                self.assertEqual(self.server.get(path, Origin=origin)[0], 403, origin)
        self.assertEqual(self.upgrade(Origin=f"http://{own}")[0], 101)

    def test_other_names_for_this_address_are_refused(self):
        for host in ("evil.example", f"evil.example:{self.server.port}", "localhost.evil.example",
                     "127.0.0.1.evil.example", "192.168.1.1", "", "[", "[::2]"):
            status, _ = self.upgrade(Host=host)
            self.assertEqual(status, 403, host)
            self.assertEqual(self.server.get("/", Host=host)[0], 403, host)
        for host in (f"localhost:{self.server.port}", "127.0.0.1", "[::1]:80", "LOCALHOST"):
            self.assertEqual(self.upgrade(Host=host)[0], 101, host)

    def test_dns_rebinding_is_refused(self):
        status, _ = self.upgrade(Host="evil.example", Origin="http://evil.example")
        self.assertEqual(status, 403)

    def test_only_the_path_ws_upgrades_to_websocket(self):
        with RawSocket(self.server) as raw:
            self.assertEqual(raw.upgrade("/elsewhere")[0], 404)
        self.assertEqual(self.server.get("/ws")[0], 426)

    def test_pages_have_security_headers(self):
        for path in ("/", "/app.js", "/rpc", "/nothing"):
            _, headers, _ = self.server.get(path)
            self.assertIn("default-src 'self'", headers["content-security-policy"])
            self.assertEqual(headers["x-content-type-options"], "nosniff")
            self.assertEqual(headers["referrer-policy"], "no-referrer")
            self.assertEqual(headers["cross-origin-resource-policy"], "same-origin")
            self.assertNotIn("access-control-allow-origin", headers)
        self.assertEqual(self.server.get("/health/live")[1]["cache-control"], "no-store")

    def test_etags_give_304_for_unchanged_files(self):
        status, headers, body = self.server.get("/app.js")
        self.assertEqual(status, 200)
        self.assertGreater(len(body), 1000)
        self.assertTrue(headers["content-type"].startswith("text/javascript"))
        status, _, body = self.server.get("/app.js", **{"If-None-Match": headers["etag"]})
        self.assertEqual((status, body), (304, b""))
        status, headers, body = self.server.request("HEAD", "/")
        self.assertEqual((status, body), (200, b""))

    def test_path_traversal_is_refused(self):
        for path in ("/../etc/passwd", "/%2e%2e/%2e%2e/etc/passwd", "//etc/passwd",
                     "/api/v1/sessions/../../etc/frame.png", "/app.js/", "/APP.JS"):
            self.assertEqual(self.server.get(path)[0], 404, path)

    def test_wrong_http_methods_give_405(self):
        self.assertEqual(self.server.get("/rpc")[0], 405)
        for method in ("POST", "PUT", "DELETE"):
            self.assertEqual(self.server.request(method, "/")[0], 405, method)


TOKEN = "a-token_of.the~tests"


class Token(ServerTestCase):
    arguments = ("--token", TOKEN)

    def setUp(self):
        pass

    def bearer(self, token):
        return {"Authorization": "Bearer " + token}

    def test_without_the_token_only_health_answers(self):
        for path in ("/", "/app.js", "/metrics", "/api/v1/schema",
                     "/api/v1/sessions/main/frame.jpg"):
            self.assertEqual(self.server.get(path)[0], 401, path)
        self.assertEqual(self.server.request("POST", "/rpc", b"{}")[0], 401)
        self.assertEqual(self.server.get("/health/live")[0], 200)
        self.assertEqual(self.server.get("/health/ready")[0], 200)

    def test_wrong_tokens_are_refused(self):
        for wrong in ("", "x", TOKEN[:-1], TOKEN + "x", TOKEN.upper(), TOKEN * 2):
            status, _, _ = self.server.get("/metrics", **self.bearer(wrong))
            self.assertEqual(status, 401, wrong)
            status, headers, _ = self.server.get("/?token=" + wrong)
            self.assertEqual(status, 401, wrong)
            self.assertNotIn("set-cookie", headers)

    def test_a_missing_and_a_wrong_token_are_told_apart(self):
        _, headers, body = self.server.get("/metrics")
        self.assertEqual(headers["www-authenticate"], "Bearer")
        self.assertIn(b"A token is required", body)
        _, headers, body = self.server.get("/metrics", **self.bearer("wrong-token-1"))
        self.assertEqual(headers["www-authenticate"], 'Bearer error="invalid_token"')
        self.assertIn(b"The token is not valid", body)

    def test_a_browser_gets_a_page_with_a_field_for_the_token(self):
        status, headers, body = self.server.get('/?session=a"<b&token=wrong-token-1',
                                                Accept="text/html,*/*")
        self.assertEqual(status, 401)
        self.assertTrue(headers["content-type"].startswith("text/html"))
        self.assertIn("default-src 'none'", headers["content-security-policy"])
        self.assertIn(b"This token is not valid", body)
        self.assertIn(b'name="session" value="a&#34;&#60;b"', body)
        self.assertNotIn(b"wrong-token-1", body)
        _, headers, _ = self.server.get("/app.js", Accept="text/html")
        self.assertTrue(headers["content-type"].startswith("text/plain"))

    def test_bearer_header_is_accepted(self):
        self.assertEqual(self.server.get("/metrics", **self.bearer(TOKEN))[0], 200)
        with RawSocket(self.server) as raw:
            self.assertEqual(raw.upgrade(Authorization="Bearer " + TOKEN)[0], 101)

    def test_token_in_the_url_becomes_a_cookie(self):
        status, headers, body = self.server.get("/?token=" + TOKEN)
        self.assertEqual((status, headers["location"]), (303, "/"))
        more = self.server.get(f"/?session=a%26b&token={TOKEN}&enter=main")[1]["location"]
        self.assertEqual(more, "/?enter=main&session=a%26b")
        cookie = headers["set-cookie"]
        self.assertIn("HttpOnly", cookie)
        self.assertIn("SameSite=Strict", cookie)
        self.assertNotIn(TOKEN.encode(), body)
        pair = cookie.split(";")[0]
        self.assertEqual(self.server.get("/", Cookie="other=1; " + pair)[0], 200)
        with RawSocket(self.server) as raw:
            self.assertEqual(raw.upgrade(Cookie=pair)[0], 101)

    def test_token_as_websocket_subprotocol_is_accepted(self):
        encoded = base64.urlsafe_b64encode(TOKEN.encode()).decode().rstrip("=")
        with RawSocket(self.server) as raw:
            status, text = raw.upgrade(
                Sec_WebSocket_Protocol=f"heliograph.v1, heliograph.v1.token.{encoded}")
            self.assertEqual(status, 101)
            self.assertNotIn(encoded, text)
        for wrong in (encoded[:-2], "", "!!!"):
            with RawSocket(self.server) as raw:
                status, _ = raw.upgrade(
                    Sec_WebSocket_Protocol=f"heliograph.v1, heliograph.v1.token.{wrong}")
                self.assertEqual(status, 401, wrong)
        with RawSocket(self.server) as raw:
            self.assertEqual(raw.upgrade()[0], 401)

    def test_foreign_origins_are_refused_despite_a_token(self):
        status, _, _ = self.server.get("/metrics", Origin="http://evil.example",
                                       **self.bearer(TOKEN))
        self.assertEqual(status, 403)

    def test_the_log_does_not_contain_the_token(self):
        self.server.get("/?token=" + TOKEN)
        self.assertNotIn(TOKEN, self.server.log_text())


class AllowedOrigin(ServerTestCase):
    arguments = ("--allow-origin", "https://viewer.example:8443")

    def setUp(self):
        pass

    def test_allowed_origins_must_match_exactly(self):
        for origin, expected in (("https://viewer.example:8443", 101),
                                 ("https://viewer.example", 403),
                                 ("http://viewer.example:8443", 403),
                                 ("https://viewer.example:84431", 403)):
            with RawSocket(self.server) as raw:
                self.assertEqual(raw.upgrade(Origin=origin)[0], expected, origin)


class FullHouse(ServerTestCase):
    arguments = ("--max-viewers", "1")

    def setUp(self):
        pass

    async def test_a_viewer_beyond_the_limit_gets_try_again_later(self):
        from harness.viewer import Viewer
        async with Viewer(self.server) as first:
            async with Viewer(self.server, greet=False) as second:
                code, reason = await second.closed()
                self.assertEqual(code, 1013)
                self.assertIn("1 viewer", reason)
            await first.call("camera.get")
        self.server.wait_for(lambda: b"heliograph_viewers 0\n" in self.server.get("/metrics")[2],
                             "the first viewer's leaving")
        async with Viewer(self.server) as third:
            await third.call("camera.get")
