"""deploy/balancer/nginx.conf: viewers, uploads, streams and downloads through a real nginx."""

import http.client
import os
import re
import shutil
import socket
import subprocess
import tempfile
import time
import unittest

from harness.images import decode_png
from harness.server import ServerTestCase
from harness.viewer import Viewer

ROOT = os.path.normpath(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", ".."))
CONFIGURATION = os.path.join(ROOT, "deploy", "balancer", "nginx.conf")
PROGRAM = shutil.which("nginx", path=os.environ["PATH"] + ":/usr/sbin:/sbin")
PLACES = ("client_body", "proxy", "fastcgi", "uwsgi", "scgi")


HIDDEN = "GET /hidden HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n"
LENGTH = f"Content-Length: {len(HIDDEN)}\r\n"
CHUNKED = "Transfer-Encoding: chunked\r\n"
LAST_CHUNK = "0\r\n\r\n"
LONGER = f"Content-Length: {len(LAST_CHUNK + HIDDEN)}\r\n"
# Headers and body of requests whose ends can be seen in two places.
AMBIGUOUS = (
    ("a length that covers it", LENGTH, HIDDEN),
    ("length and chunks", LONGER + CHUNKED, LAST_CHUNK + HIDDEN),
    ("chunks and length", CHUNKED + LONGER, LAST_CHUNK + HIDDEN),
    ("a length that ends before it, and chunks that do not", "Content-Length: 4\r\n" + CHUNKED,
     f"{len(HIDDEN):x}\r\n{HIDDEN}\r\n0\r\n\r\n"),
    ("two lengths", LENGTH + "Content-Length: 0\r\n", HIDDEN),
    ("two lengths, the other way", "Content-Length: 0\r\n" + LENGTH, HIDDEN),
    ("a list of lengths", f"Content-Length: {len(HIDDEN)}, 0\r\n", HIDDEN),
    ("a length with a sign", f"Content-Length: +{len(HIDDEN)}\r\n", HIDDEN),
    ("a hexadecimal length", f"Content-Length: 0x{len(HIDDEN):x}\r\n", HIDDEN),
    ("a space before the colon", LONGER + "Transfer-Encoding : chunked\r\n", LAST_CHUNK + HIDDEN),
    ("a tab before the value", LONGER + "Transfer-Encoding:\tchunked\r\n", LAST_CHUNK + HIDDEN),
    ("a vertical tab", LONGER + "Transfer-Encoding:\x0bchunked\r\n", LAST_CHUNK + HIDDEN),
    ("another encoding", LONGER + "Transfer-Encoding: xchunked\r\n", LAST_CHUNK + HIDDEN),
    ("two encodings", LONGER + "Transfer-Encoding: chunked, identity\r\n", LAST_CHUNK + HIDDEN),
    ("an encoding on a second line", LONGER + "Transfer-Encoding:\r\n chunked\r\n", LAST_CHUNK + HIDDEN),
    ("a header after a bare line feed", LONGER + "X: y\nTransfer-Encoding: chunked\r\n", LAST_CHUNK + HIDDEN),
    ("a header after a bare carriage return", LONGER + "X: y\rTransfer-Encoding: chunked\r\n",
     LAST_CHUNK + HIDDEN),
    ("an underscore for a hyphen", LONGER + "Transfer_Encoding: chunked\r\n", LAST_CHUNK + HIDDEN),
    ("an extension of a chunk with a line feed", CHUNKED,
     f"{len(HIDDEN):x};a=\nb\r\n{HIDDEN}\r\n0\r\n\r\n"),
    ("a chunk of 64 bits and more", CHUNKED, f"1{'0' * 16}{len(HIDDEN):x}\r\n{HIDDEN}\r\n0\r\n\r\n"),
    ("a trailer that is a header", CHUNKED, f"{len(HIDDEN):x}\r\n{HIDDEN}\r\n0\r\n{LENGTH}\r\n"),
)


def free_port():
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


class Nginx:
    """The file as it is, but for the two ports."""

    def __init__(self, folder, upstream):
        self.port = free_port()
        with open(CONFIGURATION, encoding="utf-8") as file:
            site = file.read()
        for written, port in (("listen 80;", f"listen 127.0.0.1:{self.port};"),
                              ("server 127.0.0.1:8080 ", f"server 127.0.0.1:{upstream} ")):
            assert site.count(written) == 1, written
            site = site.replace(written, port)
        with open(os.path.join(folder, "site.conf"), "w", encoding="utf-8") as file:
            file.write(site)
        temporary = "".join(f"{place}_temp_path {folder}/{place};\n" for place in PLACES)
        with open(os.path.join(folder, "nginx.conf"), "w", encoding="utf-8") as file:
            file.write(f"daemon off;\npid {folder}/pid;\nerror_log {folder}/error.log;\nevents {{}}\n"
                       f"http {{\naccess_log off;\n{temporary}include {folder}/site.conf;\n}}\n")
        self.process = subprocess.Popen(  # pylint: disable=consider-using-with
            [PROGRAM, "-p", folder, "-e", f"{folder}/error.log", "-c", f"{folder}/nginx.conf"])
        deadline = time.monotonic() + 20
        while time.monotonic() < deadline and self.process.poll() is None:
            with socket.socket() as probe:
                if probe.connect_ex(("127.0.0.1", self.port)) == 0:
                    return
            time.sleep(0.05)
        with open(f"{folder}/error.log", encoding="utf-8") as log:
            raise AssertionError("nginx does not listen: " + log.read())

    def stop(self):
        self.process.terminate()
        self.process.wait(20)


@unittest.skipUnless(PROGRAM, "nginx is not installed")
class BehindNginx(ServerTestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        uploads = os.path.join(cls.folder.name, "uploads")
        os.mkdir(uploads)
        cls.arguments = ("--trust-proxy", "127.0.0.1", "--uploads", uploads)
        super().setUpClass()
        cls.direct = cls.server.port
        cls.nginx = Nginx(cls.folder.name, cls.direct)
        cls.server.port = cls.nginx.port

    @classmethod
    def tearDownClass(cls):
        cls.server.port = cls.direct
        cls.nginx.stop()
        super().tearDownClass()

    async def test_a_viewer_gets_frames(self):
        async with Viewer(self.server) as viewer:
            self.assertEqual(viewer.hello["session"], "main")
            await viewer.next_frame()

    def test_images_come_as_from_the_server(self):
        status, _, image = self.server.get("/api/v1/sessions/main/frame.png?samples=1")
        self.assertEqual((status, decode_png(image).width), (200, 160))

    def test_a_stream_is_not_collected_first(self):
        connection = http.client.HTTPConnection("127.0.0.1", self.nginx.port, timeout=30)
        self.addCleanup(connection.close)
        connection.request("GET", "/api/v1/sessions/main/stream.mjpg")
        response = connection.getresponse()
        self.assertIn("multipart/x-mixed-replace", response.getheader("content-type"))
        self.assertIn(b"\xff\xd8", response.read(4096))

    def test_pages_of_its_own_origin_may_call(self):
        origin = f"http://127.0.0.1:{self.nginx.port}"
        status, _, _ = self.server.request("POST", "/rpc", b'{"jsonrpc":"2.0","id":1,"method":"hello"}',
                                           {"Content-Type": "application/json", "Origin": origin,
                                            "X-Forwarded-For": "203.0.113.7"})
        self.assertEqual(status, 200)
        status, _, _ = self.server.request("POST", "/rpc", b"{}", {"Origin": "http://elsewhere.example"})
        self.assertEqual(status, 403)

    def test_an_upload_arrives(self):
        with open(os.path.join(os.environ["HELIOGRAPH_SCENES"], "mirror.glb"), "rb") as file:
            status, _, answer = self.server.request("PUT", "/api/v1/scenes/through_nginx", file.read())
        self.assertEqual(status, 201, answer)

    def test_no_request_hides_in_the_body_of_another(self):
        """Whatever nginx takes for the body of an ambiguous request, the server does, too."""
        before = self.answers("404")
        self.assertEqual(self.server.get("/hidden")[0], 404)
        self.assertEqual(self.answers("404"), before + 1)  # so that hidden ones would be seen
        for name, fields, body in AMBIGUOUS:
            with self.subTest(name):
                self.send_all(f"POST /rpc HTTP/1.1\r\nHost: 127.0.0.1:{self.nginx.port}\r\n{fields}\r\n{body}")
                # On the connection that nginx keeps to the server.
                status, _, answer = self.server.get("/api/v1/schema")
                self.assertEqual((status, answer[:1]), (200, b"{"))
                self.assertEqual(self.answers("404"), before + 1)

    def send_all(self, text):
        """Until there is an answer, of whatever kind, or nothing comes."""
        with socket.create_connection(("127.0.0.1", self.nginx.port), timeout=0.5) as raw:
            try:
                raw.sendall(text.encode("latin-1"))
                raw.recv(65536)
            except OSError:
                pass

    def answers(self, status):
        page = self.server.get("/metrics")[2].decode()
        found = re.search(rf'^heliograph_http_responses_total{{status="{status}"}} (\S+)$', page, re.MULTILINE)
        return float(found[1]) if found else 0.0
