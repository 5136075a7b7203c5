#!/usr/bin/env python3
"""Renders the images that the documents show (scenes/images), so that they are those of this renderer.

    document_images.py --binaries build/bin [--only pillars ...]

Each image is of the scene's first camera, with indirect light and all else as a viewer sees it.
"""

import argparse
import pathlib
import subprocess
import tempfile

from PIL import Image

ROOT = pathlib.Path(__file__).resolve().parents[3]
FOLDER = ROOT / "scenes" / "images"
# The demo scene, which the front page shows, is larger and has its textures in full.
IMAGES = {"atrium": ("glossy_sponza_1", 1120, 480, 512)}
IMAGES |= {scene: (scene, 384, 216, 256) for scene in (
    "cubes_distance", "icosphere", "glossy_sponza_1", "glossy_sponza_2", "glossy_sponza_3",
    "shadow_objects", "pillars", "breakfast_room")}


def render(binaries, name, samples, folder):
    scene, width, height, texels = IMAGES[name]
    subprocess.run([binaries / "heliograph-scenes", folder, "--only", scene, "--texture-size",
                    str(texels)], check=True, stdout=subprocess.DEVNULL)
    rendered = folder / f"{name}.png"
    subprocess.run([binaries / "heliograph", "render", folder / f"{scene}.glb", "-o", rendered,
                    "--environment", folder / f"{scene}.hdr", "--width", str(width), "--height",
                    str(height), "--samples", str(samples)], check=True,
                   stdout=subprocess.DEVNULL)
    with Image.open(rendered) as image:
        image.convert("RGB").save(FOLDER / f"{name}.jpg", quality=88, optimize=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--binaries", type=pathlib.Path, default=ROOT / "build" / "bin")
    parser.add_argument("--only", nargs="+", choices=sorted(IMAGES), default=list(IMAGES))
    parser.add_argument("--samples", type=int, default=64)
    chosen = parser.parse_args()
    for name in chosen.only:
        with tempfile.TemporaryDirectory() as folder:
            render(chosen.binaries, name, chosen.samples, pathlib.Path(folder))
        print(FOLDER / f"{name}.jpg")


if __name__ == "__main__":
    main()
