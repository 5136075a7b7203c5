"""HTTPS and secure WebSockets of the server, with a generated certificate."""

import os
import shutil
import socket
import ssl
import subprocess
import tempfile
import time
import unittest
import warnings

from harness.raw_socket import RawSocket
from harness.server import Server, ServerTestCase
from harness.viewer import Viewer
from test_operations import run

TOKEN = "a-token_of.the~tests"


def make_certificate(folder, name="server", common_name="localhost"):
    """A key and a certificate signed by itself; returns the paths of certificate and key."""
    if not shutil.which("openssl"):
        raise unittest.SkipTest("openssl is not installed")
    certificate, key = (os.path.join(folder, name + end) for end in (".crt", ".key"))
    subprocess.run(
        ["openssl", "req", "-x509", "-newkey", "ec", "-pkeyopt", "ec_paramgen_curve:prime256v1",
         "-nodes", "-days", "2", "-subj", "/CN=" + common_name, "-addext",
         "subjectAltName=DNS:localhost,IP:127.0.0.1", "-keyout", key, "-out", certificate],
        check=True, capture_output=True)
    return certificate, key


class Tls(ServerTestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.certificate, cls.key = make_certificate(cls.folder.name)
        cls.server = Server("--tls-certificate", cls.certificate, "--tls-key", cls.key,
                            "--token", TOKEN, certificate=cls.certificate)

    def setUp(self):
        pass

    def handshake(self, context):
        with socket.create_connection((self.server.host, self.server.port), timeout=15) as plain:
            with context.wrap_socket(plain, server_hostname="localhost") as secure:
                return secure.version(), secure.cipher()[0], secure.getpeercert(True)

    def test_the_printed_url_is_https(self):
        self.assertTrue(self.server.url.startswith("https://"))

    def test_pages_and_calls(self):
        bearer = {"Authorization": "Bearer " + TOKEN}
        self.assertEqual(self.server.get("/health/ready")[0], 200)
        status, _, body = self.server.get("/app.js", **bearer)
        self.assertEqual(status, 200)
        self.assertGreater(len(body), 1000)
        self.assertEqual(self.server.get("/metrics")[0], 401)

    def test_cookies_are_only_for_tls(self):
        cookie = self.server.get("/?token=" + TOKEN)[1]["set-cookie"]
        for part in ("; Secure", "; HttpOnly", "; SameSite=Strict"):
            self.assertIn(part, cookie)

    def test_viewers(self):
        own = f"https://{self.server.host}:{self.server.port}"
        for origin, expected in ((own, 101), (own.replace("https", "http"), 403), ("null", 403)):
            with RawSocket(self.server) as raw:
                status, _ = raw.upgrade(Authorization="Bearer " + TOKEN, Origin=origin)
                self.assertEqual(status, expected, origin)

    def test_only_secure_tls_versions_are_accepted(self):
        newest = ssl.create_default_context(cafile=self.certificate)
        self.assertEqual(self.handshake(newest)[0], "TLSv1.3")
        older = ssl.create_default_context(cafile=self.certificate)
        older.maximum_version = ssl.TLSVersion.TLSv1_2
        version, cipher, _ = self.handshake(older)
        self.assertEqual(version, "TLSv1.2")
        self.assertRegex(cipher, "^ECDHE-.*(GCM|CHACHA20)")
        weak = ssl.create_default_context(cafile=self.certificate)
        weak.maximum_version = ssl.TLSVersion.TLSv1_2
        weak.set_ciphers("ECDHE-ECDSA-AES128-SHA:@SECLEVEL=0")
        self.assertRaises(ssl.SSLError, self.handshake, weak)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", DeprecationWarning)
            old = ssl.create_default_context(cafile=self.certificate)
            old.minimum_version = ssl.TLSVersion.TLSv1
            old.maximum_version = ssl.TLSVersion.TLSv1_1
            old.set_ciphers("ALL:@SECLEVEL=0")
        self.assertRaises(ssl.SSLError, self.handshake, old)

    def plain(self, data):
        with socket.create_connection((self.server.host, self.server.port), timeout=15) as raw:
            raw.sendall(data)
            received = b""
            while more := raw.recv(65536):
                received += more
            return received.decode()

    def test_plain_requests_are_sent_to_https(self):
        host = f"Host: {self.server.host}:{self.server.port}\r\n\r\n"
        answer = self.plain(f"GET /page?token={TOKEN} HTTP/1.1\r\n{host}".encode())
        self.assertIn("HTTP/1.1 308", answer)
        self.assertIn(f"Location: https://{self.server.host}:{self.server.port}/page\r\n", answer)
        self.assertNotIn(TOKEN, answer)
        answer = self.plain(f"POST /rpc HTTP/1.1\r\nContent-Length: 0\r\n{host}".encode())
        self.assertIn("HTTP/1.1 400", answer)
        upgrade = ("GET /ws HTTP/1.1\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
                   "Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n"
                   "Sec-WebSocket-Protocol: heliograph.v1\r\n")
        self.assertNotIn(" 101 ", self.plain((upgrade + host).encode()))

    def test_invalid_and_silent_handshakes_are_closed(self):
        with socket.create_connection((self.server.host, self.server.port), timeout=25) as raw:
            raw.sendall(b"\x16\x03\x01\x02\x00\x01\x00\x01\xfc" + os.urandom(600))
            try:
                while raw.recv(65536):
                    pass
            except ConnectionResetError:
                pass
        begin = time.monotonic()
        with socket.create_connection((self.server.host, self.server.port), timeout=25) as raw:
            raw.sendall(b"\x16\x03\x01")
            self.assertEqual(raw.recv(1), b"")
        self.assertLess(time.monotonic() - begin, 20)

    def test_health(self):
        url = self.server.url + "health/ready"
        self.assertEqual(run("health", "--url", url)[0], 0, "no verification on loopback")
        self.assertEqual(run("health", "--url", url, "--tls-ca", self.certificate)[0], 0)
        other, _ = make_certificate(self.folder.name, "other")
        code, _, err = run("health", "--url", url, "--tls-ca", other)
        self.assertEqual(code, 1)
        self.assertIn("verify", err)

    def test_health_finds_the_server_by_its_own_configuration(self):
        """As in a container whose health is asked for without any option."""
        environment = {"HELIOGRAPH_PORT": str(self.server.port),
                       "HELIOGRAPH_TLS_CERTIFICATE": self.certificate,
                       "HELIOGRAPH_TLS_KEY": self.key}
        expected = f"https://127.0.0.1:{self.server.port}/health/ready: 200"
        code, out, err = run("health", environment=environment)
        self.assertEqual((code, err), (0, ""))
        self.assertIn(expected, out)
        path = os.path.join(self.folder.name, "heliograph.toml")
        with open(path, "w", encoding="utf-8") as file:
            file.write("[serve]\n" + "".join(f'{name[11:].lower().replace("_", "-")} = "{value}"\n'
                                             for name, value in environment.items()))
        for arguments, more in ((("--config", path), {}), ((), {"HELIOGRAPH_CONFIG": path})):
            code, out, err = run("health", *arguments, environment=more)
            self.assertEqual((code, err), (0, ""))
            self.assertIn(expected, out)
        del environment["HELIOGRAPH_TLS_CERTIFICATE"], environment["HELIOGRAPH_TLS_KEY"]
        self.assertEqual(run("health", environment=environment)[0], 1, "it speaks TLS only")


class Reload(unittest.IsolatedAsyncioTestCase):
    async def test_a_new_certificate_is_used_without_disconnecting_viewers(self):
        with tempfile.TemporaryDirectory() as folder:
            certificate, key = make_certificate(folder)
            with Server("--tls-certificate", certificate, "--tls-key", key,
                        certificate=certificate) as server:
                async with Viewer(server) as viewer:
                    def serial():
                        context = ssl.create_default_context()
                        context.check_hostname, context.verify_mode = False, ssl.CERT_NONE
                        address = (server.host, server.port)
                        with socket.create_connection(address, timeout=15) as plain:
                            with context.wrap_socket(plain) as secure:
                                return secure.getpeercert(True)
                    first = serial()
                    new_certificate, new_key = make_certificate(folder, "new")
                    os.replace(new_certificate, certificate)
                    os.replace(new_key, key)
                    server.process.send_signal(1)
                    server.wait_for(lambda: serial() != first, "the new certificate")
                    with open(key, "w", encoding="ascii") as file:
                        file.write("nonsense")
                    second = serial()
                    server.process.send_signal(1)
                    server.wait_for(lambda: "the certificate was not reloaded" in server.log_text(),
                                    "the refusal")
                    self.assertEqual(serial(), second)
                    await viewer.call("camera.get")


class WrongOptions(unittest.TestCase):
    def test_mismatched_files_are_named(self):
        with tempfile.TemporaryDirectory() as folder:
            certificate, key = make_certificate(folder)
            _, other = make_certificate(folder, "other")
            for arguments, saying in (
                    (("--tls-certificate", certificate), "must be specified together"),
                    (("--tls-certificate", certificate, "--tls-key", other), "other.key cannot be used: key values"),
                    (("--tls-certificate", key, "--tls-key", key), "server.key"),
                    (("--tls-key", key), "tls-certificate")):
                with self.assertRaisesRegex(RuntimeError, saying):
                    Server(*arguments)
