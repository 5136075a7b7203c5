#!/usr/bin/env python3
"""Measures what the paper measured and writes it as a page and as a PDF.

    make_page.py --binary build/bin/heliograph-experiments --output build/paper
    make_page.py ... --full                        the form that can be published: many hours
    make_page.py ... --preset my.json --against best   a preset of a file beside another

What has been measured with the same options is kept: an interrupted run goes on where it stopped.
"""

import argparse
import json
import os
import pathlib
import platform
import sys

try:
    import measure
    import page as pages
    import pdf
    import plan
    import preset_page
    import records
    from results import Results
except ImportError as missing:
    # Tests read 77 as "skipped".
    print(f"make_page: {missing}: deploy/setup.sh test installs what is needed, for /usr/bin/python3",
          file=sys.stderr)
    sys.exit(77)


def options():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--binary", default="build/bin/heliograph-experiments")
    parser.add_argument("--output", default="build/paper", type=pathlib.Path)
    parser.add_argument("--size", choices=sorted(plan.SIZES), default="small")
    parser.add_argument("--full", action="store_const", const="full", dest="size",
                        help="640x360, eight seeds, ground truth of 1024 samples")
    parser.add_argument("--device", default="", help="part of the name of the Vulkan device")
    parser.add_argument("--preset", type=pathlib.Path,
                        help="a file like those in scenes/presets: a page of it beside --against")
    parser.add_argument("--against", default="best")
    parser.add_argument("--without-measuring", action="store_true",
                        help="a page of what has been measured already")
    return parser.parse_args()


def units_of(chosen, size):
    planner = plan.Planner(size, chosen.device)
    if chosen.preset:
        return list(planner.comparison(str(chosen.preset.resolve()), chosen.against))
    return planner.units()


def write(chosen, size, output, results):
    if not results.units:
        raise RuntimeError(f"nothing has been measured in {results.folder}")
    if chosen.preset:
        return [preset_page.write(results, size, output, chosen.preset.stem, chosen.against)]
    page = pages.Page(results, size, output)
    record = records.of(results, platform.machine(), os.cpu_count())
    (output / "record.json").write_text(json.dumps(record, indent=1) + "\n")
    written = [page.write()]
    return [*written, pdf.write(page, pages.TITLES)]


def main():
    chosen = options()
    size = plan.SIZES[chosen.size]
    output = chosen.output
    if chosen.preset:
        if not chosen.preset.is_file():
            raise RuntimeError(f"{chosen.preset}: no such file")
        output = output / f"preset_{chosen.preset.stem}_against_{chosen.against}"
    # Sizes do not mix: each has a folder of its own.
    runs = output / "runs" / size.name
    units = units_of(chosen, size)
    if not chosen.without_measuring:
        measure.measure(chosen.binary, units, runs)
    for path in write(chosen, size, output, Results(runs, [unit.name for unit in units])):
        print(path)


if __name__ == "__main__":
    try:
        main()
    except KeyboardInterrupt:
        print("\nmake_page: interrupted; what is finished is kept", file=sys.stderr)
        sys.exit(130)
    except (RuntimeError, OSError) as error:
        print(f"make_page: {error}", file=sys.stderr)
        sys.exit(1)
