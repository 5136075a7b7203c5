"""Runs every test_*.py in the folders beside this file. Ends with 77, which test drivers read as "skipped", where
something is missing. Names on the command line choose tests: run.py test_stream"""

import glob
import os
import sys
import unittest

HERE = os.path.dirname(os.path.abspath(__file__))


def skip(reason):
    print(f"skipped: {reason}")
    sys.exit(77)


def main():
    files = sorted(glob.glob(os.path.join(HERE, "*", "test_*.py")))
    sys.path[:0] = [HERE, *sorted({os.path.dirname(file) for file in files})]
    for variable in ("HELIOGRAPH_BINARY", "HELIOGRAPH_SCENES"):
        if not os.environ.get(variable):
            skip(f"{variable} is not set")
    try:
        import numpy  # noqa: F401
        import websockets  # noqa: F401
    except ImportError as missing:
        skip(f"python3-{missing.name} is not installed")
    loader = unittest.defaultTestLoader
    everything = [os.path.splitext(os.path.basename(file))[0] for file in files]
    suite = loader.loadTestsFromNames(sys.argv[1:] or everything)
    result = unittest.TextTestRunner(verbosity=2).run(suite)
    sys.exit(0 if result.wasSuccessful() else 1)


if __name__ == "__main__":
    main()
