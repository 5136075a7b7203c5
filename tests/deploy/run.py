"""Runs the deployment tests. Exits with 77, which test drivers treat as "skipped", if this machine
can run none of them. REQUIRE_CONTAINERS=1 makes every skipped test a failure, except those marked
"out of reach". Names on the command line select tests: run.py test_static, or
run.py test_fleet.Killed"""

import os
import sys
import unittest

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, HERE)

from harness.commands import OutOfReach  # noqa: E402

PASSED, FAILED, SKIPPED = 0, 1, 77


def main():
    try:
        import websockets  # noqa: F401
        import yaml  # noqa: F401
    except ImportError as missing:
        print(f"SKIP: {missing} (python3-websockets and python3-yaml are needed)")
        return FAILED if required() else SKIPPED
    loader = unittest.defaultTestLoader
    names = sys.argv[1:]
    suite = loader.loadTestsFromNames(names) if names else loader.discover(HERE)
    return judge(unittest.TextTestRunner(verbosity=2).run(suite))


def required():
    return os.environ.get("REQUIRE_CONTAINERS") == "1"


def judge(result):
    for test, reason in result.skipped:
        print(f"SKIP: {test.id()}: {reason}")
    if not result.wasSuccessful():
        return FAILED
    missing = [reason for _, reason in result.skipped if not reason.startswith(OutOfReach.MARK)]
    if required() and missing:
        print(f"FAIL: REQUIRE_CONTAINERS=1, and {len(missing)} of these could not run")
        return FAILED
    # A class that is skipped as a whole has started none of its tests.
    begun = [test for test, _ in result.skipped if isinstance(test, unittest.TestCase)]
    ran = result.testsRun - len(begun)
    return SKIPPED if result.skipped and ran == 0 else PASSED


if __name__ == "__main__":
    sys.exit(main())
