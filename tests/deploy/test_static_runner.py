"""The test driver: skipped tests are reported, and fail if they are required."""

import os
import subprocess
import sys
import tempfile
import textwrap
import unittest

HERE = os.path.dirname(os.path.abspath(__file__))

PROBES = """
    import unittest
    from harness.commands import OutOfReach, Skip


    class Passes(unittest.TestCase):
        def test_something(self):
            pass


    class Fails(unittest.TestCase):
        def test_something(self):
            self.fail("as it should")


    class LacksSomething(unittest.TestCase):
        @classmethod
        def setUpClass(cls):
            raise Skip("no engine")

        def test_something(self):
            self.fail("it ran")


    class LacksAnArchive(unittest.TestCase):
        @classmethod
        def setUpClass(cls):
            raise OutOfReach("an archive")

        def test_something(self):
            self.fail("it ran")


    class LacksSomethingLater(unittest.TestCase):
        def test_something(self):
            raise Skip("no engine")
"""


class Driver(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = cls.enterClassContext(tempfile.TemporaryDirectory())
        with open(os.path.join(cls.folder, "probes.py"), "w", encoding="utf-8") as file:
            file.write(textwrap.dedent(PROBES))

    def drive(self, *names, required, without=()):
        environment = {name: value for name, value in os.environ.items()
                       if name != "REQUIRE_CONTAINERS"}
        environment["PYTHONPATH"] = self.folder
        if required:
            environment["REQUIRE_CONTAINERS"] = "1"
        done = subprocess.run([*without, sys.executable, os.path.join(HERE, "run.py"), *names],
                              env=environment, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                              text=True, timeout=60)
        return done.returncode, done.stdout

    def test_skips_without_an_engine(self):
        """For an unprivileged user, or root without capabilities: no engine, no namespaces."""
        without = ["setpriv", "--bounding-set=-all"] if os.geteuid() == 0 else []
        code, said = self.drive("test_image", required=False, without=without)
        self.assertEqual(code, 77, said)
        self.assertRegex(said, r"SKIP: \S.*(need root|namespaces)")
        code, said = self.drive("test_image", required=True, without=without)
        self.assertEqual(code, 1, said)
        self.assertRegex(said, r"SKIP: \S.*(need root|namespaces)")

    def test_requires_everything_except_what_is_out_of_reach(self):
        for names, required, expected in (
                (["Passes"], True, 0),
                (["Fails", "LacksSomething"], False, 1),
                (["LacksSomething"], False, 77),
                (["LacksSomethingLater"], False, 77),
                (["Passes", "LacksSomething"], False, 0),
                (["Passes", "LacksSomething"], True, 1),
                (["Passes", "LacksSomethingLater"], True, 1),
                (["Passes", "LacksAnArchive"], True, 0),
                (["LacksAnArchive"], True, 77),
                (["LacksAnArchive", "LacksSomething"], True, 1)):
            with self.subTest(names=names, required=required):
                code, said = self.drive(*(f"probes.{name}" for name in names), required=required)
                self.assertEqual(code, expected, said)
                if "LacksSomething" in names:
                    self.assertRegex(said, r"(?m)^SKIP: .*LacksSomething.*: no engine$")
                if "LacksAnArchive" in names:
                    self.assertRegex(said, r"(?m)^SKIP: .*: out of reach: an archive$")


if __name__ == "__main__":
    unittest.main()
