"""Renders a glTF scene with Blender's Cycles as the reference path tracer means it.

Run by Blender: blender --background --python render_cycles.py -- options.json

Lights, environment and camera are set from the file itself: Blender's importer converts light
units, and knows neither the angular diameter in `extras` nor a vertical field of view at every
aspect ratio. The result is linear radiance, float32 [height, width, 3], top row first.
"""

import json
import math
import struct
import sys
from pathlib import Path

import bpy
import numpy

# Debian's importer uses a name that its NumPy no longer has.
if "bool" not in vars(numpy):
    numpy.bool = bool


def gltf_json(path):
    data = path.read_bytes()
    if data[:4] != b"glTF":
        return json.loads(data)
    length = struct.unpack_from("<I", data, 12)[0]
    return json.loads(data[20:20 + length])


def set_lights(document):
    """KHR_lights_punctual in its own units: lux for suns, candela for points and spots."""
    lights = document.get("extensions", {}).get("KHR_lights_punctual", {}).get("lights", [])
    nodes = {node.get("name"): node for node in document.get("nodes", [])}
    for found in [each for each in bpy.data.objects if each.type == "LIGHT"]:
        # Blender numbers nodes of one name: "light", "light.001".
        node = nodes.get(found.name) or nodes[found.name.rsplit(".", 1)[0]]
        wanted = lights[node["extensions"]["KHR_lights_punctual"]["light"]]
        light = found.data
        light.color = wanted.get("color", [1.0, 1.0, 1.0])
        intensity = wanted.get("intensity", 1.0)
        extras = node.get("extras", {})
        if light.type == "SUN":
            light.energy = intensity
            light.angle = math.radians(extras.get("angularDiameterDeg", 0.53))
        else:
            light.energy = intensity * 4.0 * math.pi
            light.shadow_soft_size = extras.get("radius", 0.0)


def set_environment(path):
    world = bpy.data.worlds.new("environment")
    world.use_nodes = True
    nodes, links = world.node_tree.nodes, world.node_tree.links
    image = nodes.new("ShaderNodeTexEnvironment")
    image.image = bpy.data.images.load(str(path))
    links.new(image.outputs["Color"], nodes["Background"].inputs["Color"])
    world.cycles.sampling_method = "AUTOMATIC"
    bpy.context.scene.world = world


def set_camera(document):
    """The first camera of the file; its field of view is vertical."""
    number = next(i for i, node in enumerate(document["nodes"]) if node.get("camera") == 0)
    camera = bpy.data.objects[document["nodes"][number]["name"]]
    camera.data.sensor_fit = "VERTICAL"
    camera.data.angle = document["cameras"][0]["perspective"]["yfov"]
    bpy.context.scene.camera = camera


class Nodes:
    """Builds shader nodes; an argument is a value or another node's output."""

    def __init__(self, tree):
        self.tree = tree

    def add(self, kind, output=0, settings=None, **inputs):
        node = self.tree.nodes.new(kind)
        for name, value in (settings or {}).items():
            setattr(node, name, value)
        for name, value in inputs.items():
            self.set(node.inputs[name.replace("_", " ")], value)
        return node.outputs[output]

    def set(self, socket, value):
        if isinstance(value, bpy.types.NodeSocket):
            self.tree.links.new(value, socket)
        else:
            socket.default_value = value

    def math(self, operation, *values):
        output = self.add("ShaderNodeMath", settings={"operation": operation})
        for socket, value in zip(output.node.inputs, values):
            self.set(socket, value)
        return output

    def shader(self, kind, *values):
        output = self.add(kind)
        for socket, value in zip(output.node.inputs, values):
            self.set(socket, value)
        return output

    def mix(self, share, first, second):
        return self.shader("ShaderNodeMixShader", share, first, second)

    def sum(self, first, second):
        return self.shader("ShaderNodeAddShader", first, second)


TABLE_SIZE = 32


def albedo_table():
    """Albedo of GGX with height-correlated Smith masking and Schlick's Fresnel of F0 = 0.04, as an
    image: n.v across, roughness up."""
    angle, number = numpy.meshgrid(numpy.arange(64) / 64 * 2.0 * numpy.pi,
                                   (numpy.arange(64) + 0.5) / 64)
    table = numpy.zeros((TABLE_SIZE, TABLE_SIZE), dtype=numpy.float32)
    for row in range(TABLE_SIZE):
        alpha2 = max((row + 0.5) / TABLE_SIZE, 0.02) ** 4
        cosine = numpy.sqrt((1.0 - number) / (1.0 + (alpha2 - 1.0) * number))
        sine = numpy.sqrt(1.0 - cosine ** 2)
        for column in range(TABLE_SIZE):
            n_dot_v = (column + 0.5) / TABLE_SIZE
            v_dot_h = numpy.maximum(
                numpy.sqrt(1.0 - n_dot_v ** 2) * sine * numpy.cos(angle) + n_dot_v * cosine, 1e-4)
            n_dot_l = numpy.clip(2.0 * v_dot_h * cosine - n_dot_v, 0.0, 1.0)
            masking = (n_dot_l * numpy.sqrt(n_dot_v ** 2 * (1.0 - alpha2) + alpha2)
                       + n_dot_v * numpy.sqrt(n_dot_l ** 2 * (1.0 - alpha2) + alpha2))
            fresnel = 0.04 + 0.96 * numpy.clip(1.0 - v_dot_h, 0.0, 1.0) ** 5
            weight = 2.0 * n_dot_l * v_dot_h / numpy.maximum(masking * cosine, 1e-6)
            table[row, column] = (fresnel * weight).mean()
    image = bpy.data.images.new("albedo", TABLE_SIZE, TABLE_SIZE, float_buffer=True)
    image.colorspace_settings.name = "Non-Color"
    image.pixels.foreach_set(numpy.repeat(table.ravel(), 4))
    image.pack()
    return image


def dielectric_albedo(nodes, table, roughness, normal):
    """Albedo of the specular lobe of a dielectric toward the eye."""
    facing = nodes.add("ShaderNodeLayerWeight", 1, Blend=0.5, **normal)
    place = nodes.add("ShaderNodeCombineXYZ", X=nodes.math("SUBTRACT", 1.0, facing), Y=roughness)
    return nodes.add("ShaderNodeTexImage", settings={"image": table, "extension": "EXTEND"},
                     Vector=place)


def diffuse_and_specular(nodes, table, given, normal):
    """The BRDF of the reference: GGX above Lambert, which gets what GGX as a whole leaves. Blender's
    own shader gives both lobes all light, and reflects more than it receives."""
    roughness = given("Roughness")
    glossy = {"settings": {"distribution": "MULTI_GGX"}, "Roughness": roughness, **normal}
    black = (0.0, 0.0, 0.0, 1.0)
    left = nodes.math("SUBTRACT", 1.0, dielectric_albedo(nodes, table, roughness, normal))
    below = nodes.mix(left, nodes.add("ShaderNodeBsdfDiffuse", Color=black),
                      nodes.add("ShaderNodeBsdfDiffuse", Color=given("Base Color"), **normal))
    above = nodes.add("ShaderNodeBsdfPrincipled", Base_Color=black, Metallic=0.0, Specular=0.5,
                      **glossy)
    metal = nodes.add("ShaderNodeBsdfPrincipled", Base_Color=given("Base Color"), Metallic=1.0,
                      **glossy)
    return nodes.mix(given("Metallic"), nodes.sum(below, above), metal)


def set_material(material, table):
    """`table` of albedo_table(); without it surfaces are only diffuse."""
    tree = material.node_tree
    principled = next((n for n in tree.nodes if n.type == "BSDF_PRINCIPLED"), None)
    if principled is None:
        return
    nodes = Nodes(tree)

    def given(name):
        links = principled.inputs[name].links
        return links[0].from_socket if links else principled.inputs[name].default_value

    normal = {"Normal": given("Normal")} if principled.inputs["Normal"].links else {}
    if table is None:
        scattered = nodes.add("ShaderNodeBsdfDiffuse", Color=given("Base Color"), **normal)
    else:
        scattered = diffuse_and_specular(nodes, table, given, normal)
    emission = nodes.add("ShaderNodeEmission", Color=given("Emission"),
                         Strength=given("Emission Strength"))
    surface = nodes.mix(given("Alpha"), nodes.add("ShaderNodeBsdfTransparent"),
                        nodes.sum(scattered, emission))
    for link in list(principled.outputs["BSDF"].links):
        tree.links.new(surface, link.to_socket)


def set_path_tracing(options):
    scene = bpy.context.scene
    scene.render.engine = "CYCLES"
    scene.render.resolution_x, scene.render.resolution_y = options["width"], options["height"]
    scene.render.resolution_percentage = 100
    scene.render.threads_mode = "AUTO"
    cycles = scene.cycles
    cycles.device = "CPU"
    cycles.samples = options["samples"]
    cycles.seed = 1
    cycles.use_adaptive_sampling = False
    cycles.use_denoising = False
    cycles.max_bounces = cycles.diffuse_bounces = cycles.glossy_bounces = options["bounces"]
    cycles.sample_clamp_direct = cycles.sample_clamp_indirect = 0.0
    cycles.blur_glossy = 0.0
    cycles.caustics_reflective = True
    # The reference averages over the pixel's square.
    cycles.pixel_filter_type = "BOX"
    cycles.filter_width = 1.0


def render(path):
    """Renders into a float file and returns its pixels."""
    scene = bpy.context.scene
    scene.render.image_settings.file_format = "OPEN_EXR"
    scene.render.image_settings.color_depth = "32"
    scene.render.filepath = str(path)
    bpy.ops.render.render(write_still=True)
    image = bpy.data.images.load(str(path))
    image.colorspace_settings.name = "Non-Color"
    pixels = numpy.empty(len(image.pixels), dtype=numpy.float32)
    image.pixels.foreach_get(pixels)
    return pixels.reshape(image.size[1], image.size[0], -1)[::-1, :, :3]


def main():
    options = json.loads(Path(sys.argv[sys.argv.index("--") + 1]).read_text())
    scene_file = Path(options["scene"])
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.import_scene.gltf(filepath=str(scene_file))
    document = gltf_json(scene_file)
    set_path_tracing(options)
    set_lights(document)
    set_camera(document)
    table = albedo_table() if options["specular"] else None
    for material in bpy.data.materials:
        if material.use_nodes:
            set_material(material, table)
    if options["environment"]:
        set_environment(Path(options["environment"]))
    output = Path(options["output"])
    numpy.save(output, render(output.with_suffix(".exr")))


main()
