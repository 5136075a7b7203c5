"""Comparisons of the memory that a server takes: only where it was built without sanitizers, whose own memory would
count."""

import os
import unittest

# What the server was built with, as HELIOGRAPH_SANITIZE of its build says; empty: with none.
SANITIZERS = os.environ.get("HELIOGRAPH_TEST_SANITIZERS", "")
NOT_COMPARED = f"memory is not compared: it would be that of the server's sanitizers ({SANITIZERS}), too"


def compares_memory(test):
    """Marks a test, or a class of tests, of nothing else."""
    return unittest.skipIf(SANITIZERS, NOT_COMPARED)(test)


def assert_less_memory(case, taken, limit, message=None):
    """In tests of something else, too: these go on. `taken` and `limit`: bytes."""
    with case.subTest("memory"):
        if SANITIZERS:
            case.skipTest(NOT_COMPARED)
        case.assertLess(taken, limit, message)
