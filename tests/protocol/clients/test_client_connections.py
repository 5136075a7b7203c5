"""The Python client library and failures of its connection."""

import asyncio
import os
import ssl
import subprocess
import sys
import tempfile
import unittest

from harness.server import Server, ServerTestCase
from test_python_client import LIBRARY, PROTOCOL, TOKEN, heliograph
from test_tls import make_certificate


class Mishaps(ServerTestCase):
    async def test_exceptions_of_listeners_keep_the_connection(self):
        heard = asyncio.Event()
        async with await heliograph.connect_async(self.server.url) as view:
            view.listen("camera.changed", lambda params: params["no such member"])
            view.listen("camera.changed", lambda params: heard.set())
            with self.assertLogs("heliograph", "ERROR") as logged:
                self.server.call("camera.orbit", {"yaw": 5})
                await asyncio.wait_for(heard.wait(), 15)
            self.assertIn("no such member", logged.output[0])
            scenes = await asyncio.wait_for(view.scene.list(), 15)
            self.assertEqual(scenes["current"], "mirror")

    def test_a_listener_that_calls_its_own_client_gets_an_error(self):
        with heliograph.connect(self.server.url) as view, \
                self.assertLogs("heliograph", "ERROR") as logged:
            view.listen("camera.changed", lambda params: view.scene.list())
            self.server.call("camera.orbit", {"yaw": 5})
            # Comes after the notification, by the same way.
            self.server.wait_for(lambda: view.scene.list() and logged.output, "the refusal")
        self.assertIn("call from another thread", logged.output[0])

    async def test_an_error_without_id_fails_all_pending_calls(self):
        async with await heliograph.connect_async(self.server.url) as view:
            await view.settings.patch(patch={"accumulation": {"max_samples": 65536}})
            waiting = asyncio.ensure_future(view.capture(samples=65536))
            await view.scene.list()
            await view._connection._socket.send("no JSON")
            with self.assertRaises(heliograph.HeliographError) as refused:
                await asyncio.wait_for(waiting, 15)
            self.assertEqual(refused.exception.code, -32700)
            self.assertEqual((await view.scene.list())["current"], "mirror")

    async def test_rate_limited_calls_are_all_answered(self):
        async with await heliograph.connect_async(self.server.url) as view:
            calls = [view.session.info() for _ in range(1500)]
            answers = await asyncio.wait_for(asyncio.gather(*calls, return_exceptions=True), 60)
            # A busy machine may take so long to send them that none is too many.
            refused = [one for one in answers if isinstance(one, Exception)]
            self.assertLessEqual({one.code for one in refused}, {-32002})
            self.assertLess(len(refused), len(answers))

    async def test_a_lost_connection_fails_pending_calls(self):
        view = await heliograph.connect_async(self.server.url)
        await view.settings.patch(patch={"accumulation": {"max_samples": 65536}})
        waiting = asyncio.ensure_future(view.capture(samples=65536))
        await view.scene.list()
        view._connection._reader.cancel()
        with self.assertRaises(ConnectionError):
            await asyncio.wait_for(waiting, 15)
        with self.assertRaises(ConnectionError):
            await asyncio.wait_for(view.scene.list(), 15)
        await view._connection._socket.close()


class NoServer(unittest.TestCase):
    def test_the_address_that_does_not_answer_is_told(self):
        with self.assertRaisesRegex(ConnectionError, "no server answers at http://127.0.0.1:1: .*serve starts one"):
            heliograph.connect("http://127.0.0.1:1")


class PrivateAuthority(unittest.TestCase):
    def test_a_private_authority_is_trusted_with_an_ssl_context(self):
        with tempfile.TemporaryDirectory() as folder:
            certificate, key = make_certificate(folder)
            with Server("--scene", "mirror", "--token", TOKEN, "--tls-certificate", certificate,
                        "--tls-key", key, certificate=certificate) as server:
                with self.assertRaises(ssl.SSLCertVerificationError):
                    heliograph.connect(server.url, token=TOKEN)
                trust = ssl.create_default_context(cafile=certificate)
                with heliograph.connect(server.url, token=TOKEN, ssl=trust) as view:
                    self.assertEqual(view.scene.list()["current"], "mirror")
                self.run_program(server, certificate, folder)

    def run_program(self, server, certificate, folder):
        done = subprocess.run(
            [sys.executable, os.path.join(PROTOCOL, "examples", "turntable.py"), "--url",
             server.url, "--token", TOKEN, "--tls-ca", certificate, "--images", "1", "--size",
             "64", "36", "--folder", "turn"], cwd=folder, capture_output=True, text=True,
            env={**os.environ, "PYTHONPATH": LIBRARY}, timeout=60)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(os.listdir(os.path.join(folder, "turn")), ["000.png"])
