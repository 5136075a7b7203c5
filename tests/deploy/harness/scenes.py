"""Small scenes for tests of connections."""

import os

from .commands import run

NAMES = ("mirror", "furnace")


def make_scenes(folder):
    """Generates them and returns their folder, which containers may read."""
    scenes = os.path.join(folder, "scenes")
    generate(scenes, "--texture-size", "64", "--only", "tests", "--only", "sky")
    os.chmod(folder, 0o755)
    return scenes


def generate(folder, *options):
    program = os.path.join(os.path.dirname(os.environ["HELIOGRAPH_BINARY"]), "heliograph-scenes")
    run(program, folder, *options, timeout=600)


def service_override(scenes):
    """Overrides of a compose file: the servers show these scenes at a small size."""
    return {"volumes": [f"{scenes}:/scenes:ro"],
            "environment": {"HELIOGRAPH_SCENE_ROOT": "/scenes", "HELIOGRAPH_SCENE": NAMES[0],
                            "HELIOGRAPH_WIDTH": "160", "HELIOGRAPH_HEIGHT": "90",
                            "HELIOGRAPH_DRAIN_NOTICE": "2"}}
