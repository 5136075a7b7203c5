#!/usr/bin/env python3
"""Compares the reference path tracer at scope `full` with Blender's Cycles.

    compare.py HELIOGRAPH FOLDER SCENE.glb... [--samples 4096] [--size 96x54] [--least-ssim 0.92]

Both render linear radiance of the same glTF file, a copy without what the two understand
differently: point lights of limited range, which Cycles does not have, and, in the first of two
comparisons, specular lobes. glTF's Fresnel term is Schlick's, Cycles' is exact, and 20 per cent
higher at 64 degrees from a half vector. The least similarity holds for the first comparison; what
is missing in it is Cycles' noise, and cutout leaves, which mip maps thin out here. Images
beside each other and their difference are written to FOLDER. Exit status 77: Blender or NumPy is
missing, nothing was compared.
"""

import argparse
import json
import shutil
import struct
import subprocess
import sys
import zlib
from pathlib import Path

SKIPPED = 77

try:
    import numpy
except ImportError:
    print("skipped: NumPy is missing (package python3-numpy)")
    sys.exit(SKIPPED)


def displayed(radiance):
    """Linear radiance [h, w, 3] to sRGB code values 0 to 255, clipped at white."""
    linear = numpy.clip(radiance, 0.0, 1.0)
    curved = 1.055 * numpy.power(linear, 1.0 / 2.4) - 0.055
    return 255.0 * numpy.where(linear <= 0.0031308, 12.92 * linear, curved)


def luminance(image):
    return image @ numpy.array([0.2126, 0.7152, 0.0722])


def blurred(plane):
    """Gaussian window of 11 x 11, standard deviation 1.5 (Wang et al. 2004), edges repeated."""
    weights = numpy.exp(-0.5 * (numpy.arange(-5, 6) / 1.5) ** 2)
    weights /= weights.sum()
    for axis in (0, 1):
        padding = [(5, 5) if a == axis else (0, 0) for a in (0, 1)]
        padded = numpy.pad(plane, padding, mode="edge")
        size = plane.shape[axis]
        plane = sum(weight * numpy.take(padded, range(i, i + size), axis)
                    for i, weight in enumerate(weights))
    return plane


def ssim(a, b):
    """Mean structural similarity of two planes of code values."""
    mean_a, mean_b = blurred(a), blurred(b)
    variances = blurred(a * a) - mean_a ** 2 + blurred(b * b) - mean_b ** 2
    covariance = blurred(a * b) - mean_a * mean_b
    c1, c2 = (0.01 * 255.0) ** 2, (0.03 * 255.0) ** 2
    values = ((2.0 * mean_a * mean_b + c1) * (2.0 * covariance + c2)
              / ((mean_a ** 2 + mean_b ** 2 + c1) * (variances + c2)))
    return float(values.mean())


def write_png(path, image):
    """Code values [h, w, 3]."""
    pixels = numpy.clip(image + 0.5, 0, 255).astype(numpy.uint8)
    height, width, _ = pixels.shape
    rows = b"".join(b"\0" + row.tobytes() for row in pixels)

    def chunk(kind, content):
        checksum = zlib.crc32(kind + content)
        return struct.pack(">I", len(content)) + kind + content + struct.pack(">I", checksum)

    header = struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)
    path.write_bytes(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header)
                     + chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b""))


def remove_ranged_lights(document):
    """Point and spot lights that have a range."""
    lights = document.get("extensions", {}).get("KHR_lights_punctual", {}).get("lights", [])
    for node in document["nodes"]:
        index = node.get("extensions", {}).get("KHR_lights_punctual", {}).get("light")
        if index is not None and "range" in lights[index]:
            del node["extensions"]["KHR_lights_punctual"]


def remove_specular(document):
    """Leaves the diffuse lobe of every material."""
    for material in document["materials"]:
        surface = material["pbrMetallicRoughness"]
        surface.pop("metallicRoughnessTexture", None)
        surface["metallicFactor"], surface["roughnessFactor"] = 0.0, 1.0
        material.setdefault("extensions", {})["KHR_materials_specular"] = {"specularFactor": 0.0}
    document.setdefault("extensionsUsed", []).append("KHR_materials_specular")


def copy_scene(scene, copy, changes):
    """Copies a .glb file with changes of its JSON."""
    data = scene.read_bytes()
    length = struct.unpack_from("<I", data, 12)[0]
    document = json.loads(data[20:20 + length])
    for change in changes:
        change(document)
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    rest = data[20 + length:]
    copy.write_bytes(struct.pack("<4sIII4s", b"glTF", 2, 20 + len(text) + len(rest), len(text),
                                 b"JSON") + text + rest)


def render_reference(arguments, scene, environment, output):
    command = [arguments.heliograph, "render", scene, "-o", output, "--reference", "full",
               "--buffer", "accumulated", "--samples", arguments.samples,
               "--width", arguments.width, "--height", arguments.height,
               "--set", f"reference.bounces={arguments.bounces}"]
    if environment:
        command += ["--environment", environment]
    subprocess.run([str(part) for part in command], check=True)
    return numpy.load(output)[:, :, :3].astype(numpy.float64)


def render_cycles(arguments, scene, environment, specular, output):
    options = output.with_suffix(".json")
    options.write_text(json.dumps({
        "scene": str(scene.resolve()), "environment": environment and str(environment.resolve()),
        "output": str(output.resolve()), "width": arguments.width, "height": arguments.height,
        "samples": arguments.samples, "bounces": arguments.bounces, "specular": specular}))
    script = Path(__file__).with_name("render_cycles.py")
    subprocess.run(["blender", "--background", "--factory-startup", "--python-exit-code", "1",
                    "--python", script, "--", options], check=True, stdout=subprocess.DEVNULL)
    return numpy.load(output).astype(numpy.float64)


def compare(arguments, scene, specular):
    """Prints one line for the scene; returns its similarity."""
    beside = scene.with_suffix(".hdr")
    environment = beside if beside.exists() else None
    name = "all lobes" if specular else "diffuse"
    changes = [remove_ranged_lights] + ([] if specular else [remove_specular])
    stem = arguments.folder / f"{scene.stem}_{name.replace(' ', '_')}"
    copy = Path(f"{stem}.glb")
    copy_scene(scene, copy, changes)
    ours = render_reference(arguments, copy, environment, Path(f"{stem}_reference.npy"))
    theirs = render_cycles(arguments, copy, environment, specular,
                           Path(f"{stem}_cycles.npy"))
    ours_shown, theirs_shown = displayed(ours), displayed(theirs)
    difference = 127.5 + 4.0 * (ours_shown - theirs_shown)
    write_png(Path(f"{stem}_reference_cycles_difference.png"),
              numpy.concatenate([ours_shown, theirs_shown, difference], axis=1))
    similarity = ssim(luminance(ours_shown), luminance(theirs_shown))
    ratio = luminance(numpy.clip(ours, 0, 1)).mean() / luminance(numpy.clip(theirs, 0, 1)).mean()
    print(f"{scene.stem}, {name}: SSIM {similarity:.4f}, luminance {ratio:.3f} of Cycles', "
          f"mean error {numpy.abs(ours_shown - theirs_shown).mean():.2f} of 255", flush=True)
    return similarity


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("heliograph")
    parser.add_argument("folder", type=Path)
    parser.add_argument("scenes", nargs="+", type=Path)
    parser.add_argument("--samples", type=int, default=4096)
    parser.add_argument("--size", default="96x54")
    parser.add_argument("--bounces", type=int, default=6)
    parser.add_argument("--least-ssim", type=float, default=0.92)
    arguments = parser.parse_args()
    arguments.width, arguments.height = map(int, arguments.size.split("x"))
    if not shutil.which("blender"):
        print("skipped: Blender is missing (package blender)")
        return SKIPPED
    arguments.folder.mkdir(parents=True, exist_ok=True)
    least = min(compare(arguments, scene, False) for scene in arguments.scenes)
    for scene in arguments.scenes:
        compare(arguments, scene, True)
    if least < arguments.least_ssim:
        print(f"failed: SSIM {least:.4f} is less than {arguments.least_ssim}")
    return 0 if least >= arguments.least_ssim else 1


if __name__ == "__main__":
    sys.exit(main())
