"""Measurements: exact points of meshes, values that follow a clip, and who may measure."""

import math
import os
import shutil
import tempfile

from harness.models import Model
from harness.server import Server, ServerTestCase
from harness.viewer import Viewer

CONTROL, VIEW = "steering-0123456789", "watching-0123456789"


def distance(a, b):
    return math.dist(a, b)


class Measurements(ServerTestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        scenes = os.environ["HELIOGRAPH_SCENES"]
        model = Model(os.path.join(scenes, "furnace.glb"))
        mesh = next(node["mesh"] for node in model.json["nodes"] if "mesh" in node)
        ball = model.add_node(name="ball", mesh=mesh, translation=[3, 0, 0])
        model.add_clip("roll", ball, [0, 1], [[3, 0, 0], [3, 0, 4]])
        model.save(os.path.join(cls.folder.name, "balls.glb"))
        cls.vertices = cls.vertices_of(model, mesh)
        shutil.copy(os.path.join(scenes, "mirror.glb"), cls.folder.name)
        cls.server = Server("--scene", "balls", scenes=cls.folder.name)

    @staticmethod
    def vertices_of(model, mesh):
        accessor = model.json["accessors"][model.json["meshes"][mesh]["primitives"][0]
                                           ["attributes"]["POSITION"]]
        view = model.json["bufferViews"][accessor["bufferView"]]
        start = view.get("byteOffset", 0) + accessor.get("byteOffset", 0)
        values = memoryview(bytes(model.bytes[start:start + 12 * accessor["count"]])).cast("f")
        return [tuple(values[i:i + 3]) for i in range(0, len(values), 3)]

    def reset(self):
        super().reset()
        self.server.call("scene.load", {"name": "balls"})
        self.server.call("measurements.clear")
        self.server.call("measurements.unit", {"unit": "m"})
        node = self.server.call("nodes.list", {"search": "ball"})["nodes"][0]["id"]
        self.ball = node
        self.server.call("camera.fit", {"nodes": [node]})

    def snap(self, x=0.5, y=0.5, **more):
        return self.server.call("scene.snap", {"x": x, "y": y, **more})

    def test_points_snap_to_vertices_of_the_file(self):
        size = max(max(map(abs, vertex)) for vertex in self.vertices)
        for x, y in ((0.5, 0.5), (0.47, 0.55), (0.53, 0.42)):
            snap = self.snap(x, y, radius=0.2)
            self.assertEqual((snap["hit"], snap["feature"]), (True, "vertex"))
            local = [snap["position"][0] - 3, *snap["position"][1:]]
            nearest = min(distance(local, vertex) for vertex in self.vertices)
            self.assertLess(nearest, 1e-4 * size)
            self.assertEqual(snap["surface"]["node"], self.ball)
            self.assertAlmostEqual(sum(snap["surface"]["barycentrics"]), 1, places=6)
            face = self.snap(x, y, radius=0)
            self.assertEqual(face["feature"], "face")
            self.assertLess(distance(face["position"], snap["position"]), size)
        self.server.call("camera.set", {"eye": [0, 0, 100], "target": [0, 0, 200]})
        self.assertEqual(set(self.snap().values()), {False, None})

    def test_a_distance_follows_the_clip(self):
        point = self.snap(radius=0)["surface"]
        place = self.snap(radius=0)["position"]
        added = self.server.call("measurements.add", {"kind": "distance", "points": [
            {"surface": point}, {"position": [place[0], place[1], place[2] + 4]}]})
        one = added["measurements"][0]
        self.assertAlmostEqual(one["value"], 4, places=4)
        self.assertEqual((one["id"], one["kind"], one["text"]), (1, "distance", "4 m"))
        self.server.call("animation.play", {"clip": "roll"})
        self.server.call("animation.pause")
        self.server.call("animation.seek", {"seconds": 1.0})
        listed = self.server.call("measurements.list")["measurements"][0]
        self.assertAlmostEqual(listed["value"], 0, places=4)
        self.assertLess(distance(listed["points"][0]["position"],
                                 listed["points"][1]["position"]), 1e-4)

    def test_sizes_and_units(self):
        self.server.call("measurements.add", {"kind": "size", "nodes": [self.ball]})
        listed = self.server.call("measurements.unit", {"unit": "cm"})
        size = listed["measurements"][0]
        for axis in range(3):
            column = [vertex[axis] for vertex in self.vertices]
            self.assertAlmostEqual(size["extent"][axis], max(column) - min(column), places=4)
        self.assertTrue(size["text"].endswith(" cm"), size["text"])

    def test_mistakes_name_the_member(self):
        origin = {"position": [0, 0, 0]}
        for params, path in (
                ({"kind": "length"}, "kind"),
                ({"kind": "distance", "points": [origin]}, "points"),
                ({"kind": "distance", "points": [origin, {}]}, "points[1]"),
                ({"kind": "size", "nodes": [10 ** 6]}, "nodes[0]"),
                ({"kind": "size"}, "nodes"),
                ({"kind": "angle", "points": [origin, origin, {"surface": {
                    "node": self.ball, "triangle": 10 ** 6, "barycentrics": [1, 0, 0]}}]},
                 "points[2].surface.triangle"),
                ({"kind": "distance", "points": [origin, origin], "id": 0}, "id")):
            self.assert_error(self.server.ask("measurements.add", params), -32602, path=path)
        self.assert_error(self.server.ask("measurements.remove", {"id": 9}), -32004, path="id")
        self.assert_error(self.server.ask("scene.snap", {"x": 2, "y": 0}), -32602, path="x")
        self.assertEqual(self.server.call("measurements.list")["measurements"], [])

    def test_they_stay_with_their_scene_and_in_copies(self):
        points = [{"position": [0, 0, 0]}, {"position": [0, 3, 0]}]
        self.server.call("measurements.add", {"kind": "distance", "points": points})
        self.server.call("session.create", {"name": "copy", "copy_of": "main", "width": 64,
                                            "height": 36})
        self.addCleanup(self.server.ask, "session.close", {"session": "copy"})
        self.server.call("measurements.clear", session="copy")
        self.server.call("scene.load", {"name": "mirror"})
        self.assertEqual(self.server.call("measurements.list")["measurements"], [])
        self.server.call("scene.load", {"name": "balls"})
        self.assertEqual(len(self.server.call("measurements.list")["measurements"]), 1)

    async def test_changes_are_notified_to_other_viewers(self):
        async with Viewer(self.server) as causer, Viewer(self.server) as other:
            added = await causer.call("measurements.add", {"kind": "size", "nodes": [self.ball]})
            heard = await other.notification("measurements.changed")
            self.assertEqual((heard["list"], heard["by"]), (added, causer.hello["viewer"]))


class Annotators(ServerTestCase):
    arguments = ("--token", CONTROL, "--view-token", VIEW, "--annotate", "everyone",
                 "--scene", "mirror")

    def setUp(self):
        pass

    async def test_everyone_may_measure_and_nothing_more(self):
        async with Viewer(self.server, token=VIEW) as viewer:
            self.assertEqual((viewer.hello["role"], viewer.hello["annotators"]),
                             ("view", "everyone"))
            points = [{"position": [0, 0, 0]}, {"position": [0, 3, 0]}]
            added = await viewer.call("measurements.add", {"kind": "distance", "points": points})
            self.assertEqual(added["measurements"][0]["value"], 3)
            self.assert_error(await viewer.ask("camera.fit"), -32001)
