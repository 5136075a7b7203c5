"""Renders views of glTF models with Blender's Cycles. Prints the seconds of each image as JSON.

Run by Blender: blender --background --python cycles_images.py -- work.json

The models stand in an environment, or else in a white world, as three_page.html's stand in its room; the camera is the
same.
"""

import json
import math
import os
import sys
import time

import bpy
import mathutils
import numpy

# Debian's importer uses a name that its NumPy no longer has.
if "bool" not in vars(numpy):
    numpy.bool = bool

RESULT = "seconds of the images: "


def begin(size, environment):
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    scene.render.engine = "CYCLES"
    scene.cycles.device = "CPU"
    scene.cycles.use_denoising = False
    scene.cycles.use_adaptive_sampling = False
    scene.render.use_persistent_data = True
    scene.render.resolution_x, scene.render.resolution_y = size
    world = bpy.data.worlds.new("white")
    world.use_nodes = True
    background = world.node_tree.nodes["Background"]
    background.inputs["Color"].default_value = (1.0, 1.0, 1.0, 1.0)
    if environment:
        image = world.node_tree.nodes.new("ShaderNodeTexEnvironment")
        image.image = bpy.data.images.load(environment)
        world.node_tree.links.new(image.outputs["Color"], background.inputs["Color"])
    scene.world = world


def bounding_sphere():
    """Of all meshes: the middle of their box, and half its diagonal."""
    corners = numpy.array([found.matrix_world @ mathutils.Vector(corner)
                           for found in bpy.context.scene.objects if found.type == "MESH"
                           for corner in found.bound_box])
    low, high = corners.min(axis=0), corners.max(axis=0)
    return mathutils.Vector((low + high) / 2), float(numpy.linalg.norm(high - low)) / 2


def look_from(azimuth, elevation, center, radius):
    """A camera of 45 degrees that sees the sphere; Blender's up is z, glTF's front is -y."""
    around, above = math.radians(azimuth), math.radians(elevation)
    back = mathutils.Vector((math.cos(above) * math.sin(around), -math.cos(above) * math.cos(around),
                             math.sin(above)))
    data = bpy.data.cameras.new("view")
    data.sensor_fit = "VERTICAL"
    data.angle = math.radians(45)
    data.clip_start, data.clip_end = radius / 100, radius * 100
    camera = bpy.data.objects.new("view", data)
    camera.location = center + back * radius / math.sin(math.radians(22.5))
    camera.rotation_euler = back.to_track_quat("Z", "Y").to_euler()
    bpy.context.scene.collection.objects.link(camera)
    bpy.context.scene.camera = camera


def render(path, samples):
    bpy.context.scene.cycles.samples = samples
    bpy.context.scene.render.filepath = path
    bpy.ops.render.render(write_still=True)


def main():
    with open(sys.argv[sys.argv.index("--") + 1], encoding="utf-8") as file:
        work = json.load(file)
    seconds = []
    for index, model in enumerate(work["models"]):
        before = time.monotonic()
        begin(work["size"], work.get("environment"))
        try:
            bpy.ops.import_scene.gltf(filepath=model)
            center, radius = bounding_sphere()
        except Exception:  # of any kind: its importer is written in Python
            continue  # Blender does not read this model
        for view, direction in enumerate(work["views"]):
            look_from(*direction, center, radius)
            for samples in work["samples"]:
                render(os.path.join(work["folder"], f"{index}_{view}_{samples}.png"), samples)
                seconds.append(time.monotonic() - before)
                before = time.monotonic()
    print(RESULT + json.dumps(seconds))


main()
