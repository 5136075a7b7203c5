"""Every example in the protocol's description works on a real server, as it stands there, and gives
what the description promises."""

import asyncio
import os
import shutil
import tempfile

from harness.images import encode_png
from harness.models import Model
from harness.server import Server, ServerTestCase
from harness.viewer import Viewer

# What has to be there before; everything else comes in the order of the description.
FIRST = ["hello", "scene.load", "animation.play", "session.create"]
LAST = ["reference.stop", "frame.run", "scene.unload", "session.detach", "session.join",
        "session.close"]

KINDS = {"object": dict, "array": list, "string": str, "boolean": bool, "null": type(None)}


def is_of(kind, value):
    if kind in ("number", "integer"):
        whole = isinstance(value, int) or float(value).is_integer() if isinstance(
            value, (int, float)) else False
        return (isinstance(value, (int, float)) and not isinstance(value, bool) and
                (kind == "number" or whole))
    return isinstance(value, KINDS[kind])


def problems(schema, value, path="result"):
    """What of the value is not as the schema says: the part of JSON Schema that is used."""
    kinds = schema.get("type", [])
    kinds = [kinds] if isinstance(kinds, str) else kinds
    if kinds and not any(is_of(kind, value) for kind in kinds):
        yield f"{path} is {value!r}, not {kinds}"
        return
    if "enum" in schema and value is not None and value not in schema["enum"]:
        yield f"{path} is {value!r}, not one of {schema['enum']}"
    if is_of("number", value):
        if not schema.get("minimum", value) <= value <= schema.get("maximum", value):
            yield f"{path} is {value}, out of its range"
    if isinstance(value, list):
        for index, element in enumerate(value):
            yield from problems(schema.get("items", {}), element, f"{path}[{index}]")
    if isinstance(value, dict):
        properties = schema.get("properties", {})
        for name in schema.get("required", []):
            if name not in value:
                yield f"{path}.{name} is missing"
        for name, member in value.items():
            if name in properties:
                yield from problems(properties[name], member, f"{path}.{name}")
            elif properties:
                yield f"{path}.{name} is not described"


class Examples(ServerTestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        given = os.environ["HELIOGRAPH_SCENES"]
        model = Model(os.path.join(given, "furnace.glb"))
        model.add_light("sun")
        model.json["materials"][0]["name"] = "floor"
        model.add_clip("moving_camera", model.node("diffuse"), [0.0, 10.0],
                       [[0, 0.6, 0], [1, 0.6, 0]])
        model.save(os.path.join(cls.folder.name, "atrium.glb"))
        shutil.copy(os.path.join(given, "mirror.glb"), cls.folder.name)
        shutil.copy(os.path.join(given, "sky.hdr"), cls.folder.name)
        cls.jobs = tempfile.TemporaryDirectory()
        cls.uploads = tempfile.TemporaryDirectory()
        cls.server = Server("--scene", "mirror", "--jobs", cls.jobs.name,
                            "--uploads", cls.uploads.name, scenes=cls.folder.name)
        status, _, answer = cls.server.request("PUT", "/api/v1/images/bricks",
                                               encode_png((180, 80, 60)))
        assert status == 201, answer

    @classmethod
    def tearDownClass(cls):
        super().tearDownClass()
        cls.jobs.cleanup()
        cls.uploads.cleanup()

    def in_order(self):
        methods = {one["name"]: one for one in self.server.call("rpc.discover")["methods"]}
        ends = FIRST + LAST
        order = [name for name in FIRST if name in methods]
        order += [name for name in methods if name not in ends]
        order += [name for name in LAST if name in methods]
        return [methods[name] for name in order]

    async def test_all(self):
        done, job = [], None
        async with Viewer(self.server) as viewer:
            for method in self.in_order():
                example = method["examples"][0]
                params = {param["name"]: param["value"] for param in example["params"]}
                if "job" in params:
                    params["job"] = job  # the server chose its id
                try:
                    answer = await viewer.ask(method["name"], params)
                except asyncio.TimeoutError:
                    self.fail(f"{method['name']} {params} was not answered")
                self.assertIn("result", answer, f"{method['name']} {params}: {answer}")
                wrong = list(problems(method["result"]["schema"], answer["result"],
                                      method["name"]))
                self.assertEqual(wrong, [])
                done.append(method["name"])
                if method["name"] == "job.create":
                    job = answer["result"]["job"]
        self.assertGreater(len(done), 40)

    def test_the_checker_detects_mismatches(self):
        schema = {"type": "object", "required": ["a"], "properties": {
            "a": {"type": "integer", "minimum": 1}, "b": {"type": ["string", "null"]}}}
        self.assertEqual(list(problems(schema, {"a": 1, "b": None})), [])
        for value in ({}, {"a": 0}, {"a": 1.5}, {"a": True}, {"a": 1, "b": 2}, {"a": 1, "c": 1},
                      []):
            self.assertTrue(list(problems(schema, value)), value)
