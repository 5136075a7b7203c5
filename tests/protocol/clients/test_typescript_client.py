"""The TypeScript client library, run by Node. Skipped with a message if a package is missing."""

import os
import shutil
import subprocess
import sys
import unittest

from harness.server import ServerTestCase
from test_interop import NODE_CLIENT

ROOT = os.path.normpath(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", ".."))
LIBRARY = os.path.join(ROOT, "protocol", "typescript")
TOKEN = "a-token_of.the~library"


class Generated(unittest.TestCase):
    def test_the_messages_are_up_to_date(self):
        schema = subprocess.run([os.environ["HELIOGRAPH_BINARY"], "schema"], check=True,
                                capture_output=True).stdout
        made = subprocess.run([sys.executable, os.path.join(LIBRARY, "generate.py")], check=True,
                              input=schema, capture_output=True).stdout.decode()
        with open(os.path.join(LIBRARY, "messages.ts"), encoding="utf-8") as file:
            self.assertEqual(file.read(), made, "run protocol/typescript/generate.py")


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
