#!/usr/bin/env python3
"""Writes messages.ts from the protocol's description:

    heliograph schema | protocol/typescript/generate.py > protocol/typescript/messages.ts
"""

import json
import pathlib
import re
import sys
import textwrap

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "generator"))
from description import kinds_of, read_openrpc, sentence, with_unit  # noqa: E402

HEAD = """\
// Every message of heliograph.v1, made by generate.py from `heliograph schema`.

import type { JsonObject, Vector3 } from "./json.ts";

export const subprotocol = "heliograph.v1";
"""

# Names of objects: "method" is its result or a notification's parameters, "method(name)" one of its
# parameters, and ".name" a member of either. The same object has the same name everywhere.
# All others are named after the method and the member: SceneLoadParams, SessionListLimits.
NAMES = {
    "hello": "Hello",
    "scene.list": "SceneList",
    "scene.list.scenes": "SceneEntry",
    "scene.info": "SceneInfo",
    "scene.info.clips": "ClipInfo",
    "scene.pick": "Pick",
    "camera.get": "Camera",
    "settings.get": "SettingsState",
    "settings.patch": "AppliedSettings",
    "settings.presets.presets": "PresetInfo",
    "session.list": "SessionList",
    "session.info": "SessionInfo",
    "session.info.viewers": "ViewerInfo",
    "stream.configure": "StreamSettings",
    "frame.buffers.buffers": "BufferInfo",
    "frame.capture": "Capture",
    "frame.inspect": "Inspection",
    "frame.inspect.buffers": "BufferValue",
    "frame.run": "LockstepState",
    "animation.list": "AnimationState",
    "lights.patch(patch)": "LightPatch",
    "lights.patch.light": "LightInfo",
    "materials.patch(patch)": "MaterialPatch",
    "materials.patch.material": "MaterialInfo",
    "environment.list": "EnvironmentState",
    "environment.list.environments": "EnvironmentInfo",
    "reference.status": "ReferenceState",
    "stats.frame": "FrameStats",
    "stats.frame.passes": "PassTiming",
    "scene.progress": "SceneProgress",
}
SIMPLE = {"boolean": "boolean", "integer": "number", "number": "number", "string": "string"}


def pascal(name):
    return "".join(part[:1].upper() + part[1:] for part in re.split(r"[._]", name))


def camel(name):
    return name[:1].lower() + name[1:]


def comment(text, indent):
    pad = " " * indent
    if len(pad + text) + 7 <= 100:
        return [f"{pad}/** {text} */"]
    lines = textwrap.wrap(text, 97 - indent)
    return [f"{pad}/**", *(f"{pad} * {line}" for line in lines), f"{pad} */"]


def parameters_as_object(params):
    """The schema of the object that holds these parameters."""
    return {"type": "object", "properties": {param["name"]: param["schema"] for param in params},
            "required": [param["name"] for param in params if param["required"]]}


def identity(schema):
    """Equal for two schemas of the same object, even if their own descriptions differ."""
    members = {name: json.dumps(member, sort_keys=True)
               for name, member in schema["properties"].items()}
    return json.dumps([members, sorted(schema.get("required", []))], sort_keys=True)


class Messages:
    """Collects the interfaces; an object that was written once is referred to by its name."""

    def __init__(self):
        self.names = {}
        self.lines = []

    def name_shared_objects(self, roots):
        for place, name in NAMES.items():
            root = max((root for root in roots if place == root or place.startswith(root + ".")),
                       key=len)
            schema = roots[root]
            for member in filter(None, place[len(root):].split(".")):
                schema = schema["properties"][member]
                schema = schema.get("items", schema)
            assert self.names.setdefault(identity(schema), name) == name, f"{place} has two names"

    def type_of(self, schema, name):
        """The type of a value; an object that has no name yet is called `name`."""
        kinds, nullable = kinds_of(schema)
        types = [self.type_of_kind(schema, kind, name) for kind in kinds]
        return " | ".join(types + ["null"] * nullable)

    def type_of_kind(self, schema, kind, name):
        if "enum" in schema:
            return " | ".join(json.dumps(value) for value in schema["enum"] if value is not None)
        if kind == "array":
            inner = self.type_of(schema.get("items", {}), name)
            if inner == "number" and schema.get("minItems") == schema.get("maxItems") == 3:
                return "Vector3"
            return f"({inner})[]" if " " in inner else f"{inner}[]"
        if kind == "object":
            return self.interface(schema, name)
        return SIMPLE[kind]

    def interface(self, schema, name, summary=None):
        """Writes the interface of an object unless it is there already; gives its name."""
        if "properties" not in schema:
            return "JsonObject"
        if not schema["properties"]:
            return "Empty"
        key = identity(schema)
        name = self.names.setdefault(key, name)
        if f"export interface {name} {{" in self.lines:
            return name
        body = []
        for member, inner in schema["properties"].items():
            if "description" in inner:
                body += comment(with_unit(inner["description"], inner), 2)
            optional = "" if member in schema.get("required", []) else "?"
            body.append(f"  {member}{optional}: {self.type_of(inner, name + pascal(member))};")
        self.lines += ["", *(comment(sentence(summary), 0) if summary else []),
                       f"export interface {name} {{", *body, "}"]
        return name

    def table(self, name, text, rows):
        self.lines += ["", *comment(text, 0), f"export interface {name} {{"]
        for method, row in rows:
            self.lines += [*comment(sentence(method["summary"]), 2),
                           f'  "{method["name"]}": {row};']
        self.lines.append("}")


def generate(document):
    messages = Messages()
    methods, notifications = document["methods"], document["x-notifications"]
    objects = {method["name"]: method["result"]["schema"] for method in methods}
    objects.update({one["name"]: parameters_as_object(one["params"]) for one in notifications})
    objects.update({f"{method['name']}({param['name']})": param["schema"]
                    for method in methods for param in method["params"]})
    messages.name_shared_objects(objects)
    calls = []
    for method in methods:
        name = pascal(method["name"])
        params = messages.interface(parameters_as_object(method["params"]), name + "Params",
                                    f"Parameters of {method['name']}.")
        result = messages.interface(method["result"]["schema"], name + "Result",
                                    f"Result of {method['name']}.")
        calls.append((method, f"{{ params: {params}; result: {result} }}"))
    events = []
    for one in notifications:
        name = messages.interface(objects[one["name"]], pascal(one["name"]) + "Notification",
                                  f"Parameters of the notification {one['name']}.")
        events.append((one, name))
    messages.interface(document["components"]["schemas"]["ErrorData"], "ErrorData",
                       document["components"]["schemas"]["ErrorData"]["description"])
    messages.lines += ["", *comment("An object without members.", 0),
                       "export type Empty = Record<string, never>;"]
    messages.table("Methods", "Parameters and result of every method, by its name.", calls)
    messages.table("Notifications", "Parameters of every notification of the server.", events)
    messages.lines += ["", "export const ErrorCode = {"]
    for name, error in document["components"]["errors"].items():
        messages.lines += [*comment(sentence(error["message"]), 2),
                           f"  {camel(name)}: {error['code']},"]
    messages.lines.append("} as const;")
    return HEAD + "\n".join(messages.lines) + "\n"


if __name__ == "__main__":
    sys.stdout.write(generate(read_openrpc()))
