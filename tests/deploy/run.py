"""Runs the tests of deployment. Ends with 77, which test drivers read as "skipped", where this
machine cannot run any; REQUIRE_CONTAINERS=1 makes that a failure. Names on the command line choose:
run.py test_static, or run.py test_fleet.Killed"""

import os
import sys
import unittest

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, HERE)

from harness.commands import Skip  # noqa: E402


def main():
    try:
        import websockets  # noqa: F401
        import yaml  # noqa: F401
    except ImportError as missing:
        return skip(f"{missing} (python3-websockets and python3-yaml are needed)")
    loader = unittest.defaultTestLoader
    names = sys.argv[1:]
    suite = loader.loadTestsFromNames(names) if names else loader.discover(HERE)
    result = unittest.TextTestRunner(verbosity=2).run(suite)
    if not result.wasSuccessful():
        return 1
    if result.skipped and result.testsRun <= len(result.skipped):
        return skip(result.skipped[0][1])
    return 0


def skip(reason):
    print(f"SKIP: {reason}")
    return 1 if os.environ.get("REQUIRE_CONTAINERS") == "1" else 77


if __name__ == "__main__":
    try:
        sys.exit(main())
    except Skip as reason:
        sys.exit(skip(reason))
