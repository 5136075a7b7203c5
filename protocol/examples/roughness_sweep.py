#!/usr/bin/env python3
"""Sweeps the roughness of a material and plots how bright it looks and how much it varies.

    roughness_sweep.py --scene mirror --steps 11 --plot sweep.svg
"""

import argparse

from own_session import add_options, set_samples, open_view

LUMINANCE = (0.2126, 0.7152, 0.0722)


def measure(view, material, roughness, samples):
    """Mean and standard deviation of the luminance of all pixels except the background."""
    view.materials.patch(material=material, patch={"roughness": roughness})
    light = view.array("output.radiance", samples=samples)[..., :3] @ LUMINANCE
    shown = light[view.array("gbuffer.instance", samples=1) > 0]
    return float(shown.mean()), float(shown.std())


def sweep(view, material, steps, samples):
    rows = []
    try:
        for step in range(steps):
            roughness = step / max(steps - 1, 1)
            rows.append((roughness, *measure(view, material, roughness, samples)))
            print("roughness {:.2f}: mean {:.4f}, deviation {:.4f}".format(*rows[-1]))
    finally:
        view.materials.patch(material=material, patch={"roughness": None})
    return rows


def curve(values, most, color):
    points = " ".join(f"{40 + 520 * i / max(len(values) - 1, 1):.1f},"
                      f"{260 - 220 * value / most:.1f}" for i, value in enumerate(values))
    return f'<polyline points="{points}" fill="none" stroke="{color}" stroke-width="2"/>'


def plot(rows, title):
    """The sweep as an SVG plot."""
    most = max(max(mean, deviation) for _, mean, deviation in rows) or 1.0
    texts = [(40, 20, title), (40, 290, f"roughness {rows[0][0]:g}"),
             (500, 290, f"{rows[-1][0]:g}"), (0, 45, f"{most:.2f}"), (300, 20, "blue: mean"),
             (400, 20, "red: standard deviation")]
    labels = "".join(f'<text x="{x}" y="{y}" font-size="12">{text}</text>' for x, y, text in texts)
    return ('<svg xmlns="http://www.w3.org/2000/svg" width="600" height="300">'
            '<rect width="600" height="300" fill="white"/>'
            '<path d="M40,40 V260 H560" fill="none" stroke="black"/>' + labels +
            curve([row[1] for row in rows], most, "blue") +
            curve([row[2] for row in rows], most, "red") + "</svg>\n")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    add_options(parser)
    parser.add_argument("--scene")
    parser.add_argument("--material", help="name; default: the first one")
    parser.add_argument("--steps", type=int, default=11)
    parser.add_argument("--size", type=int, nargs=2, default=(640, 360))
    parser.add_argument("--samples", type=int, default=64)
    parser.add_argument("--plot", default="sweep.svg")
    options = parser.parse_args()
    with open_view(options, *options.size, options.scene) as view:
        set_samples(view, options.samples)
        material = options.material or view.materials.list()["materials"][0]["name"]
        rows = sweep(view, material, options.steps, options.samples)
    with open(options.plot, "w", encoding="utf-8") as file:
        file.write(plot(rows, material))


if __name__ == "__main__":
    main()
