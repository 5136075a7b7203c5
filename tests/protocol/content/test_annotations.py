"""Annotations: pinned to surfaces that move, shared at once, hidden behind others."""

import math
import os
import shutil
import tempfile
import time

from harness.models import Model
from harness.server import Server, ServerTestCase
from harness.viewer import Viewer


class Annotations(ServerTestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        scenes = os.environ["HELIOGRAPH_SCENES"]
        shutil.copy(os.path.join(scenes, "mirror.glb"), cls.folder.name)
        model = Model(os.path.join(scenes, "furnace.glb"))
        mesh = next(node["mesh"] for node in model.json["nodes"] if "mesh" in node)
        ball = model.add_node(name="ball", mesh=mesh, translation=[6, 0, 0])
        model.add_clip("roll", ball, [0, 1], [[6, 0, 0], [6, 0, 8]])
        model.save(os.path.join(cls.folder.name, "balls.glb"))
        cls.server = Server("--scene", "balls", scenes=cls.folder.name)

    def reset(self):
        super().reset()
        self.server.call("scene.load", {"name": "balls"})
        self.server.call("annotations.clear")
        node = self.server.call("nodes.list", {"search": "ball"})["nodes"][0]["id"]
        self.server.call("camera.fit", {"nodes": [node]})
        self.point = self.server.call("scene.snap", {"x": 0.5, "y": 0.5, "radius": 0})

    def add(self, text="A crack", **more):
        request = {"surface": self.point["surface"], "text": text, **more}
        return self.server.call("annotations.add", request)["annotations"][-1]

    def test_an_annotation_follows_its_surface(self):
        one = self.add(author="Ada")
        self.assertEqual((one["text"], one["author"]), ("A crack", "Ada"))
        self.assertLess(math.dist(one["position"], self.point["position"]), 1e-5)
        self.server.call("animation.play", {"clip": "roll"})
        self.server.call("animation.pause")
        self.server.call("animation.seek", {"seconds": 0.5})
        moved = self.server.call("annotations.list")["annotations"][0]["position"]
        self.assertAlmostEqual(moved[2] - one["position"][2], 4, places=4)
        self.assertLess(math.dist(moved[:2], one["position"][:2]), 1e-5)

    def test_those_behind_a_surface_are_hidden(self):
        one = self.add()
        self.assertEqual(self.server.call("annotations.hidden")["hidden"], [])
        camera = self.server.call("camera.get")
        behind = [2 * target - eye for eye, target in zip(camera["eye"], camera["target"])]
        self.server.call("camera.set", {"eye": behind})
        self.assertEqual(self.server.call("annotations.hidden")["hidden"], [one["id"]])

    def test_what_is_listed_can_be_added_again(self):
        first = self.add("one", author="Ada")
        self.add("two")
        listed = self.server.call("annotations.list")["annotations"]
        self.server.call("annotations.clear")
        for one in listed:
            self.server.call("annotations.add", {name: one[name] for name in
                                                 ("surface", "text", "author", "id")})
        self.assertEqual(self.server.call("annotations.list")["annotations"], listed)
        edited = self.server.call("annotations.edit", {"id": first["id"], "text": "three"})
        self.assertEqual(edited["annotations"][0], {**first, "text": "three"})
        left = self.server.call("annotations.remove", {"id": first["id"]})
        self.assertEqual([one["text"] for one in left["annotations"]], ["two"])

    def test_mistakes_name_the_member(self):
        surface = self.point["surface"]
        for params, path in (
                ({"surface": surface, "text": ""}, "text"),
                ({"surface": surface, "text": "x" * 2001}, "text"),
                ({"text": "x"}, "surface"),
                ({"surface": {**surface, "barycentrics": [1, 1, 1]}, "text": "x"},
                 "surface.barycentrics"),
                ({"surface": {**surface, "triangle": 10 ** 8}, "text": "x"},
                 "surface.triangle")):
            self.assert_error(self.server.ask("annotations.add", params), -32602, path=path)
        for method, params in (("edit", {"id": 7, "text": "x"}), ("remove", {"id": 7})):
            self.assert_error(self.server.ask("annotations." + method, params), -32004, path="id")
        self.add(id=7)
        self.assert_error(self.server.ask("annotations.add", {
            "surface": surface, "text": "x", "id": 7}), -32009, path="id")

    def test_a_copy_of_the_session_has_its_own(self):
        one = self.add()
        self.server.call("session.create", {"name": "copy", "copy_of": "main", "width": 64,
                                            "height": 36})
        self.addCleanup(self.server.ask, "session.close", {"session": "copy"})
        copied = self.server.call("annotations.list", session="copy")["annotations"]
        self.assertEqual(copied, [one])
        self.server.call("annotations.clear", session="copy")
        self.assertEqual(self.server.call("annotations.list")["annotations"], [one])

    async def test_other_viewers_hear_of_it_at_once_with_its_author(self):
        async with Viewer(self.server, name="Ada") as causer, Viewer(self.server) as other:
            request = {"surface": self.point["surface"], "text": "Look here"}
            began = time.monotonic()
            added = await causer.call("annotations.add", request)
            heard = await other.notification("annotations.changed")
            self.assertLess(time.monotonic() - began, 1.0)
            self.assertEqual((heard["list"], heard["by"]), (added, causer.hello["viewer"]))
            self.assertEqual(heard["list"]["annotations"][0]["author"], "Ada")
