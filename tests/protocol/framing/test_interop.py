"""Clients by other hands: ws (npm), websockets and aiohttp (Debian). Each greets, asks, pings, sees
a frame and closes. Skipped with a message if a library is missing."""

import asyncio
import json
import os
import shutil
import subprocess
import unittest

from harness.server import ServerTestCase

NODE_CLIENT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "interop")


def call(number, method):
    return json.dumps({"jsonrpc": "2.0", "id": number, "method": method, "params": {}})


class Interop(ServerTestCase):
    def setUp(self):
        pass

    def check(self, saw):
        self.assertEqual(saw["magic"], "HVRF")
        self.assertEqual(saw["hello"], "heliograph.v1")
        self.assertGreater(saw["methods"], 10)
        self.assertEqual(saw["protocol"], "heliograph.v1")

    def take(self, saw, message):
        if isinstance(message, bytes):
            saw["magic"] = message[:4].decode("latin1")
            return
        message = json.loads(message)
        if message.get("id") == 1:
            saw["hello"] = message["result"]["protocol"]
        elif message.get("id") == 2:
            saw["methods"] = len(message["result"]["methods"])

    async def test_websockets(self):
        import websockets
        saw = {}
        # With compression offered, which the server does not take up.
        async with websockets.connect(self.server.websocket_url, max_size=None,
                                      subprotocols=["heliograph.v1"]) as socket:
            saw["protocol"] = socket.subprotocol
            await socket.send(call(1, "hello"))
            await socket.send(call(2, "rpc.discover"))
            await asyncio.wait_for(await socket.ping(), 20)
            while len(saw) < 4:
                self.take(saw, await asyncio.wait_for(socket.recv(), 20))
        self.assertEqual(socket.close_code, 1000)
        self.check(saw)

    async def test_aiohttp(self):
        try:
            import aiohttp
        except ImportError:
            raise unittest.SkipTest("python3-aiohttp is not installed") from None
        saw = {}
        async with aiohttp.ClientSession() as session:
            async with session.ws_connect(self.server.websocket_url, protocols=["heliograph.v1"],
                                          max_msg_size=0, compress=15) as socket:
                saw["protocol"] = socket.protocol
                await socket.send_str(call(1, "hello"))
                await socket.send_str(call(2, "rpc.discover"))
                await socket.ping(b"are you there?")
                while len(saw) < 4:
                    self.take(saw, (await asyncio.wait_for(socket.receive(), 20)).data)
                await socket.close()
            self.assertEqual(socket.close_code, 1000)
            async with session.get(self.server.url + "api/v1/schema") as response:
                self.assertIn("openrpc", await response.json())
        self.check(saw)

    def test_ws_of_node(self):
        node = shutil.which("node")
        if not node or not os.path.isdir(os.path.join(NODE_CLIENT, "node_modules", "ws")):
            raise unittest.SkipTest("node or its package ws is not installed")
        done = subprocess.run([node, "client.mjs", self.server.websocket_url], cwd=NODE_CLIENT,
                              capture_output=True, text=True, timeout=60, check=False)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        saw = json.loads(done.stdout)
        self.check(saw)
        self.assertEqual((saw["status"], saw["code"], saw["extensions"]), (101, 1000, ""))
        self.assertEqual(saw["pong"], "are you there?")
