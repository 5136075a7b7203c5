"""Runs every test_*.py beside this file. Ends with 77, which test drivers read as "skipped", where
something is missing. Names on the command line choose tests: run.py test_stream"""

import os
import sys
import unittest

HERE = os.path.dirname(os.path.abspath(__file__))


def skip(reason):
    print(f"skipped: {reason}")
    sys.exit(77)


def main():
    sys.path.insert(0, HERE)
    for variable in ("HELIOGRAPH_BINARY", "HELIOGRAPH_SCENES"):
        if not os.environ.get(variable):
            skip(f"{variable} is not set")
    try:
        import numpy  # noqa: F401
        import websockets  # noqa: F401
    except ImportError as missing:
        skip(f"python3-{missing.name} is not installed")
    loader = unittest.defaultTestLoader
    names = sys.argv[1:]
    suite = loader.loadTestsFromNames(names) if names else loader.discover(HERE)
    result = unittest.TextTestRunner(verbosity=2).run(suite)
    sys.exit(0 if result.wasSuccessful() else 1)


if __name__ == "__main__":
    main()
