"""Textures of materials that are replaced by uploaded images, removed and restored."""

import base64
import json
import os
import shutil
import subprocess
import tempfile

from harness.images import decode_png, difference, encode_png
from harness.models import Model
from harness.server import Server, ServerTestCase
from harness.viewer import Viewer

SIZE = {"width": 96, "height": 54}
SAMPLES = 48
CONTROL, VIEW = "steering-0123456789", "watching-0123456789"


RED, GREEN = encode_png((255, 0, 0)), encode_png((0, 255, 0))


class Textures(ServerTestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.uploads = tempfile.TemporaryDirectory()
        given = os.environ["HELIOGRAPH_SCENES"]
        shutil.copy(os.path.join(given, "mirror.glb"), cls.folder.name)
        model = Model(os.path.join(given, "furnace.glb"))
        model.add_light("sun", color=(1.0, 1.0, 1.0))
        model.save(os.path.join(cls.folder.name, "lit.glb"))
        cls.server = Server("--scene", "mirror", "--uploads", cls.uploads.name,
                            scenes=cls.folder.name)
        for name, image in (("red", RED), ("green", GREEN)):
            status, _, answer = cls.server.request("PUT", f"/api/v1/images/{name}", image)
            assert status == 201, answer

    def reset(self):
        super().reset()
        self.server.call("scene.load", {"name": "lit"})
        self.server.call("stream.configure", SIZE)
        self.server.call("camera.set", {"name": "main"})
        self.server.call("settings.patch", {"patch": {
            "antialiasing": {"jitter": False}, "environment": {"intensity": 0.1},
            "accumulation": {"max_samples": SAMPLES}}})

    def capture(self):
        return base64.b64decode(self.server.call("frame.capture")["data"])

    def image(self):
        return decode_png(self.capture())

    def jpeg(self):
        _, _, file = self.server.request("GET", "/api/v1/sessions/main/frame.jpg?samples=1")
        self.assertEqual(file[:2], b"\xff\xd8")
        return file

    def texture(self, **choice):
        return self.server.call("textures.set", {
            "material": "diffuse", "slot": "base_color", **choice})["texture"]

    def replaced(self):
        return [one for one in self.server.call("textures.list")["textures"]
                if "image" in one or one["removed"]]

    def test_an_uploaded_image_takes_the_place_of_a_texture(self):
        images = self.server.call("images.list")["images"]
        self.assertEqual(images, [{"name": "green", "bytes": len(GREEN), "uploaded": True},
                                  {"name": "red", "bytes": len(RED), "uploaded": True}])
        before = self.image()
        self.server.call("camera.set", {"eye": [0, 1, 4], "target": [0, 0, 0]})
        camera = self.server.call("camera.get")
        texture = self.texture(image="red")
        self.assertEqual((texture["image"], texture["removed"]), ("red", False))
        self.assertEqual(self.server.call("camera.get")["eye"], camera["eye"])
        self.server.call("camera.set", {"name": "main"})
        red = self.image()
        self.assertGreater(difference(red, before), 1)
        self.texture(image="green")
        self.assertGreater(difference(self.image(), red), 1)
        self.assertEqual([one["image"] for one in self.replaced()], ["green"])
        self.texture(removed=True)
        self.assertTrue(self.replaced()[0]["removed"])
        self.texture(image=None)
        self.assertEqual(self.replaced(), [])
        self.assertLess(difference(self.image(), before), 0.3 * difference(red, before))

    def test_a_restored_texture_gives_the_same_bytes(self):
        frames = []
        for choice in ({"image": None}, {"image": "red"}, {"image": None}):
            self.texture(**choice)
            self.server.call("frame.step", {"frames": 4, "dt": 0.04})
            frames.append(self.capture())
            self.server.call("frame.run")
        self.assertEqual(frames[0], frames[2])
        self.assertNotEqual(frames[0], frames[1])

    def test_edits_selection_and_settings_stay(self):
        self.server.call("materials.patch", {"material": "diffuse", "patch": {"roughness": 0.25}})
        self.server.call("lights.remove", {"light": "sun"})
        self.server.call("selection.set", {"nodes": [0]})
        uncut = {"planes": [], "cap_color": [0.0, 0.25, 0.75]}
        self.server.call("section.set", uncut)
        self.texture(image="green")
        self.assertEqual(self.server.call("section.get")["cap_color"], uncut["cap_color"])
        self.texture(image=None)
        self.server.call("section.set", {"planes": [{"normal": [1, 0, 0], "offset": 5}]})
        before = self.server.call("edits.get")["edits"]
        self.texture(image="red")
        after = self.server.call("edits.get")["edits"]
        self.assertEqual(after.pop("textures"), [
            {"material": "diffuse", "slot": "base_color", "image": "red"}])
        self.assertEqual(before.pop("textures"), [])
        self.assertEqual(after, before)
        self.assertEqual(self.server.call("selection.get")["nodes"], [0])

    def test_refusals_name_the_member_and_change_nothing(self):
        for change, code, path in (
                ({"material": "difuse"}, -32004, "material"),
                ({"slot": "colour"}, -32004, "slot"),
                ({"image": "blue"}, -32004, "image"),
                ({"image": "../red"}, -32004, "image"),
                ({"removed": True}, -32602, "image"),
                ({"imag": "red"}, -32602, "imag")):
            request = {"material": "diffuse", "slot": "base_color", "image": "red", **change}
            with self.subTest(path):
                self.assert_error(self.server.ask("textures.set", request), code, path=path)
        request = {"material": "diffuse", "slot": "base_color"}
        self.assert_error(self.server.ask("textures.set", request), -32602, path="image")
        self.assertEqual(self.replaced(), [])
        for texture, path in (({"image": "blue"}, "edits.textures[0].image"),
                              ({"material": "difuse"}, "edits.textures[0].material"),
                              ({"slot": "colour"}, "edits.textures[0].slot")):
            entry = {"material": "diffuse", "slot": "base_color", "image": "red", **texture}
            document = {"version": 1, "textures": [entry]}
            answer = self.server.ask("edits.apply", {"edits": document})
            self.assert_error(answer, -32004, path=path)
        self.server.call("scene.unload")
        answer = self.server.ask("textures.set", {**request, "image": "red"})
        self.assertIn("no scene", answer["error"]["message"])

    def test_other_sessions_keep_their_textures(self):
        self.server.call("session.create", {"name": "other", "scene": "lit", **SIZE})
        try:
            self.texture(image="red")
            textures = self.server.call("textures.list", session="other")["textures"]
            self.assertFalse(any("image" in one for one in textures))
        finally:
            self.server.call("session.close", {"session": "other"})

    async def test_other_viewers_hear_of_it(self):
        async with Viewer(self.server) as causer, Viewer(self.server) as other:
            await causer.call("textures.set", {"material": "diffuse", "slot": "base_color",
                                               "image": "red"})
            heard = await other.notification("textures.changed")
            self.assertEqual(heard["by"], causer.hello["viewer"])

    def test_documents_carry_textures(self):
        plain = self.server.call("edits.get")["edits"]
        before = self.image()
        self.texture(image="red")
        document = self.server.call("edits.get")["edits"]
        red = self.image()
        self.server.call("edits.apply", {"edits": plain})
        self.assertEqual(self.replaced(), [])
        self.assertLess(difference(self.image(), before), 0.3 * difference(red, before))
        self.server.call("edits.apply", {"edits": document})
        self.assertEqual(self.server.call("edits.get")["edits"], document)
        self.server.call("scene.load", {"name": "mirror"})
        self.server.call("scene.load", {"name": "lit", "edits": document})
        self.assertEqual(self.server.call("edits.get")["edits"], document)
        self.server.call("camera.set", {"name": "main"})
        self.assertLess(difference(self.image(), red), 0.3 * difference(red, before))

    def test_documents_of_another_scene_name_the_material(self):
        document = {"version": 1, "textures": [
            {"material": "nothing", "slot": "base_color", "image": "red"}]}
        answer = self.server.ask("scene.load", {"name": "lit", "edits": document})
        self.assert_error(answer, -32004, path="edits.textures")
        self.assertIn("nothing", answer["error"]["message"])

    def render(self, output, *arguments):
        return subprocess.run(
            [os.environ["HELIOGRAPH_BINARY"], "render", os.path.join(self.folder.name, "lit.glb"),
             "-o", output, "--width", "96", "--height", "54", "--samples", str(SAMPLES),
             "--camera", "main", "--set", "antialiasing.jitter=false", *arguments],
            capture_output=True, text=True, timeout=300, check=False)

    def test_the_command_line_renders_the_document(self):
        before = self.image()
        self.texture(image="red")
        red = self.image()
        document = os.path.join(self.folder.name, "edits.json")
        with open(document, "w", encoding="utf-8") as file:
            json.dump(self.server.call("edits.get")["edits"], file)
        output = os.path.join(self.uploads.name, "rendered.png")
        done = self.render(output, "--edits", document)
        self.assertNotEqual(done.returncode, 0)
        self.assertIn("edits.textures[0].image", done.stderr)
        images = os.path.join(self.uploads.name, "images")
        done = self.render(output, "--edits", document, "--images", images)
        self.assertEqual(done.returncode, 0, done.stderr)
        with open(output, "rb") as file:
            rendered = decode_png(file.read())
        self.assertLess(difference(rendered, red), 0.3 * difference(red, before))
        beside = os.path.join(self.folder.name, "red.png")
        shutil.copy(os.path.join(images, "red.png"), beside)
        self.addCleanup(os.remove, beside)
        done = self.render(os.path.join(self.uploads.name, "out.png"), "--edits", document)
        self.assertEqual(done.returncode, 0, done.stderr)

    def test_exported_files_have_the_image(self):
        self.texture(image="red")
        status, _, body = self.server.get("/api/v1/sessions/main/scene.glb")
        self.assertEqual(status, 200, body[:200])
        self.assertIn(RED, body)

    def test_uploads_of_images_are_checked(self):
        for name, body, expected in (("red", b"no image" * 20, 400), ("red", RED[:-30], 400),
                                     ("a.png", RED, 400), ("..", RED, 400)):
            status, _, answer = self.server.request("PUT", f"/api/v1/images/{name}", body)
            self.assertIn(status, (expected, 404), (name, answer))
            self.assertNotIn(self.uploads.name.encode(), answer)
        for damaged, why in ((RED[:-30], b"is a damaged PNG: the data ends early"),
                             (self.jpeg()[:-200], b"is a damaged JPEG"),
                             (b"no image" * 20, b"is neither PNG, JPEG, WebP nor KTX2")):
            status, _, answer = self.server.request("PUT", "/api/v1/images/hurt", damaged)
            self.assertEqual(status, 400)
            self.assertIn(b"the image hurt " + why, answer)
        status, _, answer = self.server.request("PUT", "/api/v1/images/red", RED)
        self.assertEqual((status, json.loads(answer)), (
            201, {"name": "red", "bytes": len(RED), "width": 4, "height": 4}))
        for method in ("GET", "POST"):
            status, headers, _ = self.server.request(method, "/api/v1/images/red")
            self.assertEqual((status, headers["allow"]), (405, "PUT, DELETE"), method)

    def test_an_image_that_was_damaged_since_is_not_shown_as_one_texel(self):
        file = os.path.join(self.uploads.name, "images", "worn.png")
        with open(file, "wb") as image:
            image.write(RED[:-30])
        self.addCleanup(os.remove, file)
        answer = self.server.ask("textures.set", {
            "material": "diffuse", "slot": "base_color", "image": "worn"})
        self.assert_error(answer, -32602, path="image")
        self.assertIn("is a damaged PNG", answer["error"]["message"])
        self.assertEqual(self.replaced(), [])

    def test_an_image_that_is_uploaded_again_is_shown(self):
        status, _, _ = self.server.request("PUT", "/api/v1/images/changing", RED)
        self.assertEqual(status, 201)
        self.texture(image="changing")
        red = self.image()
        self.server.request("PUT", "/api/v1/images/changing", GREEN)
        self.texture(image="changing")
        self.assertGreater(difference(self.image(), red), 1)
        os.remove(os.path.join(self.uploads.name, "images", "changing.png"))

    def test_an_image_of_another_format_takes_the_place_of_one_in_use(self):
        def upload(file):
            status, _, answer = self.server.request("PUT", "/api/v1/images/planks", file)
            self.assertEqual(status, 201, answer)
        upload(RED)
        for slot in ("base_color", "emissive"):
            self.texture(slot=slot, image="planks")
        upload(self.jpeg())  # the file of that name is another one now
        self.texture(slot="normal", image="green")
        self.assertEqual(sorted(one["image"] for one in self.replaced()),
                         ["green", "planks", "planks"])
        for slot in ("base_color", "emissive", "normal"):
            self.texture(slot=slot, image=None)
        self.assertEqual(self.replaced(), [])
        os.remove(os.path.join(self.uploads.name, "images", "planks.jpg"))

    def test_read_only_tokens_upload_and_change_nothing(self):
        with Server("--scene", "lit", "--token", CONTROL, "--view-token", VIEW, "--uploads",
                    self.uploads.name, scenes=self.folder.name) as server:
            watching = {"Authorization": "Bearer " + VIEW}
            self.assertEqual(server.request("PUT", "/api/v1/images/x", RED, watching)[0], 403)
            call = json.dumps({"jsonrpc": "2.0", "id": 1, "method": "textures.set", "params": {
                "material": "diffuse", "slot": "base_color", "image": "red"}})
            _, _, body = server.request("POST", "/rpc", call, watching)
            self.assertEqual(json.loads(body)["error"]["code"], -32001)
