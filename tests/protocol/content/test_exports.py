"""Edited scenes as new .glb files: over HTTP, and with `heliograph export`."""

import base64
import json
import os
import shutil
import struct
import subprocess
import tempfile

from harness.images import decode_png, difference
from harness.models import Model
from harness.server import Server, ServerTestCase

FILE = "/api/v1/sessions/main/scene.glb"
CONTROL, VIEW = "steering-0123456789", "watching-0123456789"


def document_of(file):
    """The JSON of a .glb file."""
    magic, version, length, size, kind = struct.unpack_from("<4sIII4s", file)
    assert (magic, version, length, kind) == (b"glTF", 2, len(file), b"JSON")
    return json.loads(file[20:20 + size])


class Exports(ServerTestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        given = os.environ["HELIOGRAPH_SCENES"]
        shutil.copy(os.path.join(given, "mirror.glb"), cls.folder.name)
        model = Model(os.path.join(given, "furnace.glb"))
        model.add_light("sun", color=(1.0, 0.5, 0.25))
        model.add_light("fill", kind="point", intensity=20.0, translation=[0, 3, 0])
        model.save(os.path.join(cls.folder.name, "lit.glb"))
        cls.server = Server("--scene", "lit", scenes=cls.folder.name)

    def reset(self):
        super().reset()
        self.server.call("scene.load", {"name": "lit"})
        self.view()

    def view(self):
        self.server.call("camera.set", {"name": "main"})
        self.server.call("settings.patch", {"patch": {
            "antialiasing": {"jitter": False}, "environment": {"intensity": 0.1, "rotation": 0},
            "accumulation": {"max_samples": 48}}})

    def image(self):
        capture = self.server.call("frame.capture")
        return decode_png(base64.b64decode(capture["data"]))

    def edit(self):
        self.server.call("lights.patch", {"light": "fill", "patch": {
            "temperature": 2500, "intensity": 40, "position": [1, 2, 0]}})
        self.server.call("lights.remove", {"light": "sun"})
        self.server.call("lights.add", {"type": "spot", "name": "new spot"})
        self.server.call("materials.patch", {"material": "diffuse", "patch": {
            "base_color": [1, 0, 0], "emissive": [0, 3, 0]}})
        return self.server.call("edits.get")["edits"]

    def exported(self):
        status, headers, body = self.server.get(FILE)
        self.assertEqual(status, 200, body[:200])
        return headers, body

    def path(self, name):
        return os.path.join(self.folder.name, name)

    def run_export(self, *arguments):
        done = subprocess.run([os.environ["HELIOGRAPH_BINARY"], "export", *arguments],
                              capture_output=True, text=True, timeout=120, check=False)
        return done.returncode, done.stderr

    def test_the_file_shows_what_the_session_shows(self):
        before = self.image()
        self.edit()
        edited = self.image()
        self.assertGreater(difference(edited, before), 3)
        headers, body = self.exported()
        self.assertEqual(headers["content-type"], "model/gltf-binary")
        self.assertIn('filename="lit_edited.glb"', headers["content-disposition"])
        with open(self.path("again.glb"), "wb") as file:
            file.write(body)
        self.server.call("scene.load", {"name": "again"})
        self.view()
        lights = [light["name"] for light in self.server.call("lights.list")["lights"]]
        self.assertEqual(sorted(lights), ["fill", "new spot"])
        self.assertEqual(self.server.call("edits.get")["edits"]["lights"], [])
        self.assertLess(difference(self.image(), edited), 0.5)

    def test_what_the_file_lacks_is_told_in_a_header(self):
        self.server.call("settings.patch", {"patch": {"environment": {"intensity": 1}}})
        headers, _ = self.exported()
        self.assertNotIn("x-heliograph-warnings", headers)
        self.server.call("section.set", {"planes": [{"normal": [1, 0, 0], "offset": 0}]})
        self.server.call("lights.add", {"type": "disk", "name": "Fläche"})
        headers, _ = self.exported()
        self.assertTrue(headers["x-heliograph-warnings"].isascii())
        planes, area = json.loads(headers["x-heliograph-warnings"])
        self.assertIn("section planes", planes)
        self.assertIn("Fl??che", area, "quoted as in errors")

    def test_refusals(self):
        for path, expected in ((FILE.replace("main", "nowhere"), 404), (FILE + "?samples=1", 400)):
            self.assertEqual(self.server.get(path)[0], expected, path)
        for method in ("HEAD", "POST", "PUT", "DELETE"):
            status, headers, _ = self.server.request(method, FILE)
            self.assertEqual((status, headers["allow"]), (405, "GET"), method)
        self.server.call("scene.unload")
        status, _, body = self.server.get(FILE)
        self.assertEqual(status, 503)
        self.assertIn(b"no scene is loaded", body)

    def test_a_file_that_changed_since_it_was_loaded_is_refused(self):
        path = self.path("changing.glb")
        shutil.copy(self.path("lit.glb"), path)
        self.server.call("scene.load", {"name": "changing"})
        with open(path, "ab") as file:
            file.write(b"more")
        status, _, body = self.server.get(FILE)
        self.assertEqual(status, 409)
        self.assertIn(b"have changed", body)
        os.remove(path)
        self.assertEqual(self.server.get(FILE)[0], 409)

    def test_temporary_files_are_removed(self):
        before = set(os.listdir(tempfile.gettempdir()))  # of servers that were killed
        for _ in range(3):
            self.exported()
        left = [name for name in set(os.listdir(tempfile.gettempdir())) - before
                if name.startswith("heliograph-scene-")]
        self.server.wait_for(lambda: not any(os.path.exists(os.path.join(
            tempfile.gettempdir(), name)) for name in left), "no files left")

    def test_read_only_tokens_get_no_files(self):
        with Server("--scene", "lit", "--token", CONTROL, "--view-token", VIEW,
                    scenes=self.folder.name) as server:
            for token, expected in ((VIEW, 403), (CONTROL, 200), ("wrong-0123456789", 401)):
                status, _, _ = server.get(FILE, Authorization="Bearer " + token)
                self.assertEqual(status, expected, token)

    def test_the_command_line_writes_the_same_file(self):
        edits = self.path("edits.json")
        with open(edits, "w", encoding="utf-8") as file:
            json.dump(self.edit(), file)
        _, body = self.exported()
        output = self.path("of_command.glb")
        code, errors = self.run_export(self.path("lit.glb"), "--edits", edits, "-o", output)
        self.assertEqual(code, 0, errors)
        self.assertIn("environment", errors, "its intensity is told")
        with open(output, "rb") as file:
            written = file.read()
        # Numbers of the document were read from its text once more.
        self.assertEqual(document_of(written).keys(), document_of(body).keys())
        self.assertEqual(written[-1000:], body[-1000:])
        os.remove(output)

    def test_the_command_line_names_what_is_wrong_and_writes_nothing(self):
        scene, wrong = self.path("lit.glb"), self.path("wrong.json")
        with open(wrong, "w", encoding="utf-8") as file:
            file.write('{"version": 1, "removed_lights": ["moon"]}')
        output = self.path("x.glb")
        for arguments, expected in (
                ((scene,), "--output"),
                ((scene, "-o", self.path("x.gltf")), "must end in .glb"),
                ((scene, "-o", scene), "is the scene itself"),
                ((scene, "-o", self.folder.name + "/lit.glb/x.glb"), "cannot write"),
                ((scene, "-o", output, "--edits", wrong), "edits.removed_lights[0]"),
                ((scene, "-o", output, "--edits", self.path("none.json")), "none.json"),
                ((scene, "-o", output, "--variant", "red"), 'no variant "red"'),
                ((scene, "-o", output, "--max-scene-bytes", "100"), "lit.glb: the file has"),
                ((self.path("none.glb"), "-o", output), "none.glb: the file does not exist"),
                ((scene, "-o", output, "--edit", wrong), "did you mean --edits?")):
            with self.subTest(expected):
                code, errors = self.run_export(*arguments)
                self.assertIn(code, (1, 2))
                self.assertIn(expected, errors)
                self.assertFalse(os.path.exists(output))
        self.assertEqual([name for name in os.listdir(self.folder.name) if "part" in name], [])
