"""Edits of a session as a document, and lights that it adds and removes."""

import base64
import json
import os
import shutil
import subprocess
import tempfile

from harness.images import decode_png, difference
from harness.models import Model
from harness.server import Server, ServerTestCase
from harness.viewer import Viewer

SIZE = {"width": 96, "height": 54}


class EditDocuments(ServerTestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        given = os.environ["HELIOGRAPH_SCENES"]
        for name in ("mirror.glb", "furnace.glb", "white.hdr"):
            shutil.copy(os.path.join(given, name), cls.folder.name)
        model = Model(os.path.join(given, "furnace.glb"))
        model.add_light("sun", color=(1.0, 0.5, 0.25))
        model.add_light("fill", kind="point", intensity=20.0, translation=[0, 3, 0])
        model.save(os.path.join(cls.folder.name, "lit.glb"))
        cls.server = Server("--scene", "mirror", scenes=cls.folder.name)

    def reset(self):
        super().reset()
        self.server.call("scene.load", {"name": "lit"})
        self.server.call("camera.fit")
        self.server.call("environment.set", {"name": None, "rotation": 0})
        self.server.call("settings.patch", {"patch": {
            "antialiasing": {"jitter": False}, "environment": {"intensity": 0.1},
            "accumulation": {"max_samples": 48}}})

    def image(self):
        capture = self.server.call("frame.capture")
        return decode_png(base64.b64decode(capture["data"]))

    def names(self):
        return [light["name"] for light in self.server.call("lights.list")["lights"]]

    def test_added_lights_shine_and_removed_ones_do_not(self):
        before = self.image()
        for kind in ("directional", "point", "spot", "rectangle", "disk"):
            with self.subTest(kind):
                light = self.server.call("lights.add", {"type": kind})["light"]
                self.assertTrue(light["added"])
                lit = self.image()
                self.assertGreater(lit.mean(), before.mean() + 0.5)
                self.server.call("lights.remove", {"light": light["name"]})
                self.assertLess(difference(self.image(), before), 0.3 * difference(lit, before))
        self.server.call("lights.remove", {"light": "sun"})
        self.assertEqual(self.names(), ["fill"])
        dark = self.image()
        self.assertLess(dark.mean(), before.mean() - 0.5)
        self.server.call("lights.add", {"type": "directional", "name": "sun"})
        self.assertLess(difference(self.image(), before), 0.3 * difference(dark, before))

    def test_many_lights_can_be_added_up_to_a_limit(self):
        for _ in range(256):
            self.server.call("lights.add", {"type": "point", "patch": {"intensity": 0.01}})
        self.image()
        answer = self.server.ask("lights.add", {"type": "point"})
        self.assert_error(answer, -32029, limit="256")

    def test_refused_lights_change_nothing(self):
        before = self.server.call("lights.list")
        for params, code, path in (
                ({"type": "point", "name": "sun"}, -32009, "name"),
                ({"type": "point", "patch": {"width": 1}}, -32602, "patch.width"),
                ({"type": "candle"}, -32602, "type"),
                ({"type": "spot", "patch": {"inner_cone": 50, "outer_cone": 40}}, -32602,
                 "patch.outer_cone"),
                ({"type": "point", "patch": {"temperature": 100}}, -32602, "patch.temperature")):
            self.assert_error(self.server.ask("lights.add", params), code, path=path)
        self.assert_error(self.server.ask("lights.remove", {"light": "moon"}), -32004,
                          path="light")
        self.assertEqual(self.server.call("lights.list"), before)

    def edit(self):
        """Edits of every kind; the document."""
        self.server.call("lights.patch", {"light": "fill", "patch": {"temperature": 2500}})
        self.server.call("lights.remove", {"light": "sun"})
        self.server.call("lights.add", {"type": "rectangle", "name": "panel"})
        self.server.call("materials.patch",
                         {"material": "diffuse", "patch": {"base_color": [1, 0, 0]}})
        nodes = self.server.call("nodes.list", {"search": "mirror"})["nodes"]
        if nodes:
            self.server.call("nodes.patch", {"nodes": [nodes[0]["id"]],
                                             "patch": {"visible": False}})
        self.server.call("environment.set", {"name": "white", "rotation": 20})
        return self.server.call("edits.get")["edits"]

    def test_a_document_brings_the_edits_back(self):
        plain = self.server.call("edits.get")["edits"]
        self.assertEqual((plain["lights"], plain["hidden"]), ([], []))
        before = self.image()
        document = self.edit()
        edited = self.image()
        self.assertGreater(difference(edited, before), 3)
        self.server.call("edits.apply", {"edits": plain})
        self.assertEqual(self.server.call("edits.get")["edits"], plain)
        self.assertLess(difference(self.image(), before), 0.5)
        self.server.call("edits.apply", {"edits": document})
        self.assertEqual(self.server.call("edits.get")["edits"], document)
        self.assertLess(difference(self.image(), edited), 0.5)
        self.server.call("scene.load", {"name": "mirror"})
        self.server.call("scene.load", {"name": "lit", "edits": document})
        self.assertEqual(self.server.call("edits.get")["edits"], document)
        self.server.call("camera.fit")
        self.assertLess(difference(self.image(), edited), 0.5)

    def test_a_document_that_does_not_fit_changes_nothing(self):
        self.server.call("lights.patch", {"light": "sun", "patch": {"intensity": 5}})
        before = self.server.call("edits.get")
        for change, path in (
                ({"version": 2}, "edits.version"),
                ({"candles": []}, "edits.candles"),
                ({"lights": [{"light": "moon", "patch": {}}]}, "edits.lights[0].light"),
                ({"materials": [{"material": "diffuse", "patch": {"roughness": 2}}]},
                 "edits.materials[0].patch.roughness"),
                ({"added_lights": [{"type": "point", "name": "fill"}]},
                 "edits.added_lights[0].name"),
                ({"hidden": [100000]}, "edits.hidden[0]"),
                ({"environment": {"name": "withe"}}, "edits.environment.name")):
            document = {"version": 1, **change}
            with self.subTest(path):
                answer = self.server.ask("edits.apply", {"edits": document})
                self.assertEqual(answer["error"]["data"]["path"], path)
                answer = self.server.ask("scene.load", {"name": "lit", "edits": document})
                self.assertEqual(answer["error"]["data"]["path"], path)
        self.assertEqual(self.server.call("edits.get")["edits"], before["edits"])

    async def test_other_viewers_hear_of_documents(self):
        async with Viewer(self.server) as causer, Viewer(self.server) as other:
            await causer.call("lights.add", {"type": "point"})
            heard = await other.notification("edits.changed")
            self.assertEqual(heard["by"], causer.hello["viewer"])
            await causer.call("edits.apply", {"edits": {"version": 1}})
            await other.notification("edits.changed")

    def test_the_command_line_renders_a_document(self):
        document = self.edit()
        path = os.path.join(self.folder.name, "edits.json")
        with open(path, "w", encoding="utf-8") as file:
            json.dump(document, file)
        images = {}
        for name, more in (("plain", []), ("edited", ["--edits", path])):
            output = os.path.join(self.folder.name, name + ".png")
            self.render(output, *more)
            with open(output, "rb") as file:
                images[name] = decode_png(file.read())
        self.assertGreater(difference(images["edited"], images["plain"]), 3)
        self.server.call("stream.configure", SIZE)
        self.server.call("camera.set", {"name": "main"})
        self.assertLess(difference(self.image(), images["edited"]), 0.5)

    def test_the_command_line_names_what_is_wrong_in_a_document(self):
        path = os.path.join(self.folder.name, "wrong.json")
        for text, expected in (("{", "no JSON"), ('{"version": 1, "candles": []}', "candles"),
                               ('{"version": 1, "removed_lights": ["moon"]}',
                                "edits.removed_lights[0]")):
            with open(path, "w", encoding="utf-8") as file:
                file.write(text)
            with self.subTest(expected):
                done = self.render(os.path.join(self.folder.name, "x.png"), "--edits", path,
                                   check=False)
                self.assertNotEqual(done.returncode, 0)
                self.assertIn(expected, done.stderr)

    def render(self, output, *more, check=True):
        return subprocess.run(
            [os.environ["HELIOGRAPH_BINARY"], "render", os.path.join(self.folder.name, "lit.glb"),
             "-o", output, "--width", "96", "--height", "54", "--camera", "main",
             "--set", "antialiasing.jitter=false", "--set", "accumulation.max_samples=48",
             "--set", "environment.intensity=0.1", *more],
            check=check, capture_output=True, text=True, timeout=300)
