#!/usr/bin/env python3
"""Loads large scenes with heliograph-bench-loading, and cancels loads of them.

    python3 tests/bench/load_large_scenes.py build/bin/heliograph-bench-loading FOLDER [--smoke]

Fails where a load takes more memory at its peak than 1.5 times what stays, or goes on for longer
than a quarter of a second after it was cancelled. The files are written to FOLDER. With --smoke
they are small, and limits are those of a program that hardly has a scene.
"""

import argparse
import os
import subprocess
import sys

import large_scenes

# What is large, and when loads are cancelled, seconds.
LARGE = {
    "triangles": dict(triangles=10_000_000, meshes=100),
    "one_mesh": dict(triangles=10_000_000, textures=1, normal_maps=True),
    "textures": dict(textures=2000, triangles=20_000, meshes=100),
    "large_textures": dict(textures=16, texture_size=4096),
    "instances": dict(instances=100_000, meshes=50, triangles=10_000),
}
SMALL = {
    "triangles": dict(triangles=20_000, meshes=10),
    "one_mesh": dict(triangles=20_000, textures=1, normal_maps=True),
    "textures": dict(textures=20, texture_size=64),
    "instances": dict(instances=1_000, meshes=5),
}
MOST_PEAK = 1.5
MOST_LATE = 0.25


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("program")
    parser.add_argument("folder")
    parser.add_argument("--smoke", action="store_true")
    options = parser.parse_args()
    os.makedirs(options.folder, exist_ok=True)
    failed = []
    for name, content in (SMALL if options.smoke else LARGE).items():
        path = os.path.join(options.folder, f"large_{name}.glb")
        large_scenes.write_scene(path, **content)
        moments = ["0", "0.01"] if options.smoke else ["0.1", "0.3", "1", "2", "4", "8"]
        limits = [] if options.smoke else ["--most-peak", str(MOST_PEAK),
                                           "--most-late", str(MOST_LATE)]
        ended = subprocess.run([options.program, path, "--repeats", "1", "--cancel", *moments,
                                *limits], check=False)
        os.remove(path)
        if ended.returncode != 0:
            failed.append(name)
    if failed:
        sys.exit("failed: " + ", ".join(failed))


if __name__ == "__main__":
    main()
