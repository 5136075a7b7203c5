"""An agent's view of the server: the Model Context Protocol on stdio and over HTTP."""

import base64
import copy
import json
import math
import os
import subprocess
import tempfile
import unittest
import urllib.error
import urllib.request

from harness.images import decode_png
from harness.models import Model
from harness.server import Server

DEFECT = "part 2"
CONTROL, VIEW = "control-token-of-the-test", "view-token-of-the-test"


def scene_with_a_defect(path):
    """A row of grey spheres, of which one is red."""
    model = Model(os.path.join(os.environ["HELIOGRAPH_SCENES"], "furnace.glb"))
    model.json["nodes"] = []
    model.json["scenes"][0]["nodes"] = []
    model.json.pop("cameras", None)
    red = copy.deepcopy(model.json["materials"][0])
    red["pbrMetallicRoughness"] = {"baseColorFactor": [0.9, 0.02, 0.02, 1], "metallicFactor": 0}
    model.json["materials"].append(red)
    model.json["meshes"].append(copy.deepcopy(model.json["meshes"][0]))
    model.json["meshes"][-1]["primitives"][0]["material"] = len(model.json["materials"]) - 1
    for i in range(4):
        name = f"part {i}"
        mesh = len(model.json["meshes"]) - 1 if name == DEFECT else 0
        model.add_node(name=name, mesh=mesh, translation=[2.5 * i, 0, 0])
    model.save(path)


class Agent:
    def __init__(self, *arguments):
        self.process = subprocess.Popen(
            [os.environ["HELIOGRAPH_BINARY"], "mcp", *arguments], text=True,
            stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        self.asked = 0

    def send(self, text):
        self.process.stdin.write(text + "\n")
        self.process.stdin.flush()

    def answer(self):
        return json.loads(self.process.stdout.readline())

    def ask(self, method, params=None):
        self.asked += 1
        self.send(json.dumps({"jsonrpc": "2.0", "id": self.asked, "method": method,
                              "params": params or {}}))
        answer = self.answer()
        assert answer["id"] == self.asked, answer
        return answer

    def call(self, tool, **arguments):
        return self.ask("tools/call", {"name": tool, "arguments": arguments})["result"]

    def result(self, tool, **arguments):
        answer = self.call(tool, **arguments)
        assert not answer["isError"], answer
        return json.loads(answer["content"][-1]["text"])

    def look(self):
        content = self.call("frame_capture", format="png")["content"]
        image = next(part for part in content if part["type"] == "image")
        assert image["mimeType"] == "image/png"
        return decode_png(base64.b64decode(image["data"]))

    def close(self):
        self.process.stdin.close()
        code = self.process.wait(30)
        self.process.stdout.close()
        self.process.stderr.close()
        return code


def reddest(image):
    """How red the reddest pixel is, and where it lies in the image."""
    excess = [image.rgb[i] - max(image.rgb[i + 1], image.rgb[i + 2])
              for i in range(0, len(image.rgb), 3)]
    most = max(range(len(excess)), key=excess.__getitem__)
    row, column = divmod(most, image.width)
    return excess[most], (column + 0.5) / image.width, (row + 0.5) / image.height


class ModelContextProtocol(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        scene_with_a_defect(os.path.join(cls.folder.name, "parts.glb"))
        cls.agent = Agent("--scene", "parts", "--scene-root", cls.folder.name, "--width", "160",
                          "--height", "64", "--set", "accumulation.max_samples=4")

    @classmethod
    def tearDownClass(cls):
        try:
            assert cls.agent.close() == 0
        finally:
            cls.folder.cleanup()

    def test_a_client_finds_a_planted_defect_by_looking(self):
        self.agent.result("camera_fit")
        redness, x, y = reddest(self.agent.look())
        self.assertGreater(redness, 60)
        node = self.agent.result("scene_pick", x=x, y=y)["node"]
        self.assertEqual(self.agent.result("nodes_info", nodes=[node])["names"], [DEFECT])
        self.agent.result("nodes_patch", nodes=[node], patch={"visible": False})
        self.assertLess(reddest(self.agent.look())[0], 30)
        self.agent.result("nodes_patch", nodes=[node], patch={"visible": True})

    def test_a_client_measures_and_annotates_what_it_sees(self):
        self.agent.result("camera_fit")
        _, x, y = reddest(self.agent.look())
        snap = self.agent.result("scene_snap", x=x, y=y, radius=0)
        node = snap["surface"]["node"]
        self.assertEqual(self.agent.result("nodes_info", nodes=[node])["names"], [DEFECT])
        added = self.agent.result("measurements_add", kind="size", nodes=[node])
        extent = added["measurements"][-1]["extent"]
        centre = [2.5 * int(DEFECT[-1]), 0, 0]
        away = math.dist(snap["position"], centre)
        self.assertAlmostEqual(away / (max(extent) / 2), 1, delta=0.05)
        beyond = [snap["position"][0], snap["position"][1], snap["position"][2] + 3]
        added = self.agent.result("measurements_add", kind="distance", points=[
            {"surface": snap["surface"]}, {"position": beyond}])
        self.assertAlmostEqual(added["measurements"][-1]["value"], 3, places=4)
        noted = self.agent.result("annotations_add", surface=snap["surface"], text="Red")
        self.assertEqual(noted["annotations"][-1]["text"], "Red")
        failed = self.agent.call("measurements_add", kind="distance", points=[])
        self.assertTrue(failed["isError"])
        self.assertIn("points", failed["content"][0]["text"])
        for kind in ("measurements", "annotations"):
            self.assertEqual(self.agent.result(f"{kind}_clear")[kind], [])

    def test_the_server_introduces_itself_and_its_tools(self):
        hello = self.agent.ask("initialize", {"protocolVersion": "2025-03-26", "capabilities": {},
                                              "clientInfo": {"name": "test", "version": "1"}})
        self.assertEqual(hello["result"]["protocolVersion"], "2025-03-26")
        self.assertEqual(hello["result"]["serverInfo"]["name"], "heliograph")
        unknown = self.agent.ask("initialize", {"protocolVersion": "1999-01-01"})
        self.assertEqual(unknown["result"]["protocolVersion"], "2025-06-18")
        self.agent.send('{"jsonrpc": "2.0", "method": "notifications/initialized"}')
        self.assertEqual(self.agent.ask("ping")["result"], {})
        tools = {tool["name"]: tool for tool in self.agent.ask("tools/list")["result"]["tools"]}
        self.assertLessEqual({"scene_load", "frame_capture", "scene_pick", "nodes_list"}, set(tools))
        self.assertFalse({"hello", "stream_ack", "stats_subscribe"} & set(tools))
        self.assertEqual(tools["nodes_list"]["inputSchema"]["type"], "object")
        self.assertIn("search", tools["nodes_list"]["inputSchema"]["properties"])
        self.assertTrue(tools["nodes_list"]["annotations"]["readOnlyHint"])
        self.assertFalse(tools["nodes_patch"]["annotations"]["readOnlyHint"])

    def test_mistakes_are_explained(self):
        failed = self.agent.call("camera_set", vertical_fov=0)
        self.assertTrue(failed["isError"])
        self.assertIn("vertical_fov", failed["content"][0]["text"])
        for method, params, part in (("tools/call", {"name": "fly"}, "params.name"),
                                     ("tools/call", {}, "params.name"),
                                     ("resources/list", {}, "resources/list")):
            self.assertIn(part, self.agent.ask(method, params)["error"]["message"])
        for text in ("{", "[]", '{"id": 1}'):
            self.agent.send(text)
            self.assertIn("error", self.agent.answer())
        self.assertEqual(self.agent.ask("ping")["result"], {})


class OverHttp(unittest.TestCase):
    """The same tools of a server that others use, too."""

    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        scene_with_a_defect(os.path.join(cls.folder.name, "parts.glb"))
        cls.addClassCleanup(cls.folder.cleanup)
        cls.server = Server("--scene", "parts", "--token", CONTROL, "--view-token", VIEW,
                            scenes=cls.folder.name)
        cls.addClassCleanup(cls.server.__exit__)

    def post(self, message, token=CONTROL, **headers):
        request = urllib.request.Request(
            self.server.url + "mcp", data=json.dumps(message).encode(), method="POST",
            headers={"Content-Type": "application/json", "Authorization": f"Bearer {token}",
                     "Accept": "application/json, text/event-stream",
                     **{name.replace("_", "-"): value for name, value in headers.items()}})
        with urllib.request.urlopen(request, timeout=60) as answer:
            return answer.status, answer.headers.get_content_type(), answer.read()

    def refused(self, message, **options):
        with self.assertRaises(urllib.error.HTTPError) as caught:
            self.post(message, **options)
        caught.exception.close()
        return caught.exception.code

    def call(self, tool, token=CONTROL, **arguments):
        _, kind, body = self.post({"jsonrpc": "2.0", "id": 7, "method": "tools/call",
                                   "params": {"name": tool, "arguments": arguments}}, token)
        self.assertEqual(kind, "application/json")
        return json.loads(body)["result"]

    def test_a_client_finds_a_planted_defect_by_looking(self):
        self.call("camera_fit")
        content = self.call("frame_capture", format="png")["content"]
        image = next(part for part in content if part["type"] == "image")
        _, x, y = reddest(decode_png(base64.b64decode(image["data"])))
        node = json.loads(self.call("scene_pick", x=x, y=y)["content"][-1]["text"])["node"]
        info = self.call("nodes_info", nodes=[node])["content"][-1]["text"]
        self.assertEqual(json.loads(info)["names"], [DEFECT])

    def test_messages_and_their_answers_follow_the_transport(self):
        ping = {"jsonrpc": "2.0", "id": 1, "method": "ping"}
        status, _, body = self.post({"jsonrpc": "2.0", "method": "notifications/initialized"})
        self.assertEqual((status, body), (202, b""))
        self.assertEqual(self.post(ping, MCP_Protocol_Version="2025-06-18")[0], 200)
        self.assertEqual(self.refused(ping, MCP_Protocol_Version="1999-01-01"), 400)
        self.assertEqual(self.refused(ping, Origin="https://elsewhere.example"), 403)
        self.assertEqual(self.refused(ping, token="wrong"), 401)
        request = urllib.request.Request(self.server.url + "mcp",
                                         headers={"Authorization": f"Bearer {CONTROL}"})
        with self.assertRaises(urllib.error.HTTPError) as caught:
            urllib.request.urlopen(request, timeout=60)
        self.assertEqual((caught.exception.code, caught.exception.headers["Allow"]), (405, "POST"))
        caught.exception.close()

    def test_a_view_token_looks_and_changes_nothing(self):
        self.assertFalse(self.call("scene_info", token=VIEW)["isError"])
        refused = self.call("camera_fit", token=VIEW)
        self.assertTrue(refused["isError"])


if __name__ == "__main__":
    unittest.main()
