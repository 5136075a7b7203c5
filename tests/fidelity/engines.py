"""The engines of Khronos' glTF-Render-Fidelity set, by the names of their images."""

# Whether an engine traces paths. Source: the table "Engines used" of the set's site
# (src/data/ABOUT.md of KhronosGroup/glTF-Render-Fidelity), which names them by their products;
# `three` has taken the place of `model-viewer`, which stands for three.js there.
PATH_TRACED = {
    "babylon": False,
    "blender-cycles": True,
    "filament": False,
    "gltf-sample-viewer": False,
    "model-viewer": False,
    "stellar": True,
    "three": False,
    "three-gpu-pathtracer": True,
    "vray": True,
}


def unknown(names):
    """Those that the table lacks. They take part, but are not taken for path traced."""
    return sorted(set(names) - set(PATH_TRACED))


def path_traced(names):
    return sorted(name for name in names if PATH_TRACED.get(name, False))
