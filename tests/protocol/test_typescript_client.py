"""The client library in TypeScript, run by Node. Skipped, saying so, where a package is missing."""

import os
import shutil
import subprocess
import unittest

from harness.server import ServerTestCase
from test_interop import NODE_CLIENT

ROOT = os.path.normpath(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", ".."))
TOKEN = "a-token_of.the~library"


class TypeScriptLibrary(ServerTestCase):
    arguments = ("--scene", "mirror", "--token", TOKEN)

    def setUp(self):
        pass

    def test_by_node(self):
        node = shutil.which("node")
        needed = [os.path.join(NODE_CLIENT, "node_modules", "ws"),
                  os.path.join(ROOT, "web_client", "node_modules", "esbuild")]
        if not node or not all(map(os.path.isdir, needed)):
            raise unittest.SkipTest("node or its packages ws and esbuild are not installed")
        done = subprocess.run(
            [node, "typescript_client.mjs"], cwd=NODE_CLIENT, capture_output=True, text=True,
            timeout=180, check=False,
            env={**os.environ, "HELIOGRAPH_TEST_URL": self.server.websocket_url,
                 "HELIOGRAPH_TEST_TOKEN": TOKEN})
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        self.assertIn("# pass 7", done.stdout.replace("ℹ", "#"))
