"""Nodes of a session: hierarchy, visibility, selection, and views of some of them."""

import base64
import os
import shutil
import tempfile

from harness.images import decode_png, difference
from harness.models import Model
from harness.server import Server, ServerTestCase
from harness.viewer import Viewer


class Nodes(ServerTestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        model = Model(os.path.join(os.environ["HELIOGRAPH_SCENES"], "furnace.glb"))
        model.add_light("sun")
        mesh = next(node["mesh"] for node in model.json["nodes"] if "mesh" in node)
        wheel = model.add_node(name="Wheel", mesh=mesh, translation=[3, 0, 0])
        model.json["scenes"][0]["nodes"].remove(wheel)
        model.add_node(name="axle", children=[wheel])
        model.save(os.path.join(cls.folder.name, "parts.glb"))
        shutil.copy(os.path.join(os.environ["HELIOGRAPH_SCENES"], "mirror.glb"), cls.folder.name)
        cls.server = Server("--scene", "parts", "--set", "antialiasing.jitter=false",
                            "--set", "accumulation.max_samples=16", scenes=cls.folder.name)

    def reset(self):
        super().reset()
        self.server.call("scene.load", {"name": "parts"})
        self.server.call("camera.fit")

    def image(self):
        capture = self.server.call("frame.capture")
        return decode_png(base64.b64decode(capture["data"]))

    def node(self, name):
        found = self.server.call("nodes.list", {"search": name})["nodes"]
        return next(node for node in found if node["name"] == name)

    def show(self, node, visible):
        return self.server.call("nodes.patch", {"nodes": [node], "patch": {"visible": visible}})

    def test_nodes_are_listed_in_parts_and_found_in_any_case(self):
        listed = self.server.call("nodes.list")
        self.assertEqual(listed["total"], self.server.call("scene.info")["nodes"])
        self.assertEqual([node["id"] for node in listed["nodes"]], list(range(listed["total"])))
        part = self.server.call("nodes.list", {"first": 1, "count": 1})
        self.assertEqual((part["nodes"], part["total"]), (listed["nodes"][1:2], listed["total"]))
        wheel, axle = self.node("Wheel"), self.node("axle")
        self.assertEqual((wheel["parent"], wheel["meshes"], axle["meshes"]), (axle["id"], 1, 0))
        self.assertIn(wheel, self.server.call("nodes.list", {"search": "wHEE"})["nodes"])

    def test_properties_include_what_is_below(self):
        wheel = self.server.call("nodes.info", {"nodes": [self.node("Wheel")["id"]]})
        axle = self.server.call("nodes.info", {"nodes": [self.node("axle")["id"]]})
        self.assertEqual({**axle, "names": ["Wheel"]}, wheel)
        self.assertEqual(wheel["instances"], 1)
        self.assertGreater(wheel["triangles"], 0)
        low, high = wheel["bounds"]["min"], wheel["bounds"]["max"]
        self.assertAlmostEqual((low[0] + high[0]) / 2, 3, places=3)
        self.assertEqual(len(wheel["materials"]), 1)

    def test_an_exploded_view_moves_parts_apart(self):
        wheel = self.node("Wheel")["id"]
        whole, properties = self.image(), self.server.call("nodes.info", {"nodes": [wheel]})
        eye = self.server.call("camera.get")["eye"]
        self.server.call("camera.fit", {"nodes": [wheel]})
        self.assertEqual(self.server.call("scene.pick", {"x": 0.5, "y": 0.5})["node"], wheel)
        self.server.call("settings.patch", {"patch": {"view": {"explode": 2}}})
        self.assertNotEqual(self.server.call("scene.pick", {"x": 0.5, "y": 0.5})["node"], wheel)
        self.assertEqual(self.server.call("nodes.info", {"nodes": [wheel]}), properties)
        # Into the view where it is now.
        self.server.call("camera.fit", {"nodes": [wheel]})
        self.assertEqual(self.server.call("scene.pick", {"x": 0.5, "y": 0.5})["node"], wheel)
        self.server.call("camera.fit")
        farther = self.server.call("camera.get")["eye"]
        self.assertGreater(sum(e * e for e in farther), 1.5 * sum(e * e for e in eye))
        self.server.call("settings.patch", {"patch": {"view": {"explode": None}}})
        self.server.call("camera.fit")
        self.assertLess(difference(self.image(), whole), 0.5)

    def test_hidden_nodes_vanish_from_image_and_pick(self):
        axle, wheel = self.node("axle")["id"], self.node("Wheel")["id"]
        self.server.call("camera.fit", {"nodes": [wheel]})
        before = self.image()
        self.assertEqual(self.server.call("scene.pick", {"x": 0.5, "y": 0.5})["node"], wheel)
        self.assertEqual(self.show(axle, False)["hidden"], [axle])
        gone = self.image()
        self.assertGreater(difference(gone, before), 2)
        self.assertNotEqual(self.server.call("scene.pick", {"x": 0.5, "y": 0.5})["node"], wheel)
        self.assertFalse(self.server.call("nodes.info", {"nodes": [wheel]})["shown"])
        self.assertTrue(self.node("Wheel")["visible"], "only the node above it is hidden")
        self.assertEqual(self.show(axle, None)["hidden"], [])
        self.assertLess(difference(self.image(), before), 0.1)

    def test_isolated_nodes_are_all_that_is_shown(self):
        wheel = self.node("Wheel")["id"]
        others = [node["id"] for node in self.server.call("nodes.list")["nodes"]
                  if node["meshes"] and node["id"] != wheel]
        state = self.server.call("nodes.isolate", {"nodes": [wheel]})
        self.assertEqual(state["isolated"], [wheel])
        self.assertTrue(self.server.call("nodes.info", {"nodes": [wheel]})["shown"])
        self.assertFalse(self.server.call("nodes.info", {"nodes": others})["shown"])
        self.assertEqual(self.server.call("nodes.isolate", {"nodes": []})["isolated"], [])
        self.assertTrue(self.server.call("nodes.info", {"nodes": others})["shown"])

    def test_a_selection_is_outlined_in_captures_alone(self):
        wheel = self.node("Wheel")["id"]
        self.server.call("camera.fit", {"nodes": [wheel]})
        before = self.image()
        self.assertEqual(self.server.call("selection.set", {"nodes": [wheel, wheel]})["nodes"],
                         [wheel])
        self.assertEqual(self.server.call("selection.get")["nodes"], [wheel])
        outlined = self.image()

        def changed(after):
            return sum(abs(a - b) > 60 for a, b in zip(after.rgb, before.rgb)) / len(before.rgb)

        self.assertGreater(changed(outlined), 0.001)
        self.assertLess(changed(outlined), 0.05)
        self.server.call("selection.set", {"nodes": []})
        self.assertEqual(changed(self.image()), 0)

    def test_unknown_nodes_are_refused_by_their_place(self):
        count = self.server.call("scene.info")["nodes"]
        for method, params in (("nodes.info", {}), ("nodes.isolate", {}), ("selection.set", {}),
                               ("camera.fit", {}), ("nodes.patch", {"patch": {"visible": False}})):
            answer = self.server.ask(method, {"nodes": [0, count], **params})
            self.assert_error(answer, -32602, path="nodes[1]")
            self.assertIn(f"0..{count - 1}", answer["error"]["message"])
        answer = self.server.ask("nodes.patch", {"nodes": [0], "patch": {"visibel": False}})
        self.assert_error(answer, -32602, path="patch.visibel")
        self.assertEqual(self.server.call("nodes.isolate", {"nodes": []})["hidden"], [])

    def test_a_copy_of_the_session_has_its_own_nodes(self):
        wheel = self.node("Wheel")["id"]
        self.show(wheel, False)
        self.server.call("session.create", {"name": "copy", "copy_of": "main", "width": 64,
                                            "height": 36})
        self.addCleanup(self.server.ask, "session.close", {"session": "copy"})
        here = self.server.call("nodes.info", {"nodes": [wheel]}, session="copy")
        self.assertFalse(here["shown"])
        self.server.call("nodes.patch", {"nodes": [wheel], "patch": {"visible": True}},
                         session="copy")
        self.assertFalse(self.server.call("nodes.info", {"nodes": [wheel]})["shown"])

    async def test_changes_are_notified_to_other_viewers(self):
        wheel = self.node("Wheel")["id"]
        async with Viewer(self.server) as causer, Viewer(self.server) as other:
            await causer.call("selection.set", {"nodes": [wheel]})
            self.assertEqual((await other.notification("selection.changed"))["nodes"], [wheel])
            await causer.call("nodes.patch", {"nodes": [wheel], "patch": {"visible": False}})
            heard = await other.notification("nodes.changed")
            self.assertEqual((heard["hidden"], heard["by"]), ([wheel], causer.hello["viewer"]))
