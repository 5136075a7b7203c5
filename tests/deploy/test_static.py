"""Static checks of scripts, packages, unit and Dockerfile: seconds, no engine, no root."""

import json
import os
import re
import shutil
import subprocess
import tempfile
import unittest

from harness.checkout import Checkout
from harness.commands import run
from harness.files import DEPLOY, ROOT, files, text_of

UNIT = os.path.join(DEPLOY, "systemd/heliograph.service")

class Scripts(unittest.TestCase):
    paths = files("*.sh") + files("*.sh", os.path.join(ROOT, "tests")) + [
        os.path.join(ROOT, ".ci/run")] + files("p*", os.path.join(DEPLOY, "debian"))

    def test_parse(self):
        self.assertGreater(len(self.paths), 6)
        for path in self.paths:
            shell = "bash" if "bash" in text_of(path).split("\n", 1)[0] else "sh"
            with self.subTest(path):
                run(shell, "-n", path)

    def test_pass_shellcheck(self):
        if not shutil.which("shellcheck"):
            self.skipTest("shellcheck is not installed")
        run("shellcheck", "--severity=warning", *self.paths)

    def test_stop_at_the_first_error(self):
        for path in self.paths:
            with self.subTest(path):
                self.assertRegex(text_of(path), r"(?m)^set -e")


class Packages(unittest.TestCase):
    def test_are_listed_once_with_a_known_purpose(self):
        seen = set()
        for line in text_of(os.path.join(DEPLOY, "packages")).splitlines():
            if not line or line.startswith("#"):
                continue
            purpose, package, *_ = line.split()
            package = package.removesuffix("?")
            with self.subTest(package):
                self.assertIn(purpose, {"build", "run", "image", "test", "deploy"})
                self.assertNotIn(package, seen)
            seen.add(package)

    def test_optional_packages_may_be_missing(self):
        """Runs setup.sh as an unprivileged user, which prints the packages to install."""
        if not shutil.which("apt-get"):
            self.skipTest("there is no apt-get here")
        without_rights = ["setpriv", "--reuid=65534", "--regid=65534", "--clear-groups"] \
            if os.geteuid() == 0 else []
        with tempfile.TemporaryDirectory() as folder:
            os.chmod(folder, 0o755)
            shutil.copy(os.path.join(DEPLOY, "setup.sh"), folder)
            for listed, code, message in (
                    ("deploy no-such-1?\ndeploy no-such-2? no-such\n", 0,
                     "every package is installed"),
                    ("deploy no-such-1?\ndeploy no-such-2\n", 1,
                     "apt-get install --no-install-recommends no-such-2\n"),
                    ("deploy no-such-1 bash\nbuild no-such-2\n", 0,
                     "every package is installed")):
                with open(os.path.join(folder, "packages"), "w", encoding="ascii") as file:
                    file.write(listed)
                with self.subTest(listed):
                    said = subprocess.run(
                        [*without_rights, os.path.join(folder, "setup.sh"), "deploy"],
                        stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, timeout=60)
                    self.assertEqual(said.returncode, code, said.stdout)
                    self.assertIn(message, said.stdout)

    def test_are_listed_in_one_place(self):
        """Build dependencies are installed by setup.sh only."""
        listed = {line.split()[1] for line in text_of(os.path.join(DEPLOY, "packages")).splitlines()
                  if line.startswith("build ")}
        dockerfile = text_of(os.path.join(DEPLOY, "Dockerfile"))
        self.assertIn("deploy/setup.sh build", dockerfile)
        self.assertEqual([name for name in listed if re.search(rf"install[^\n]*\s{name}\s",
                                                               dockerfile)], [])


class BillOfMaterials(unittest.TestCase):
    def test_names_the_packages_of_a_program_and_its_libraries(self):
        if not shutil.which("dpkg-query"):
            self.skipTest("the packages of this system are not Debian's")
        script = os.path.join(DEPLOY, "sbom.sh")
        bill = json.loads(run(script, "lister", "1.2", "/usr/bin/ls",
                              env={**os.environ, "SOURCE_DATE_EPOCH": "86400"}))
        self.assertEqual((bill["spdxVersion"], bill["creationInfo"]["created"]),
                         ("SPDX-2.3", "1970-01-02T00:00:00Z"))
        packages = {package["SPDXID"]: package for package in bill["packages"]}
        self.assertEqual(len(packages), len(bill["packages"]))
        related = {relation["relatedSpdxElement"] for relation in bill["relationships"]}
        self.assertEqual(related, set(packages))
        names = {package["name"] for package in packages.values()}
        self.assertLessEqual({"lister", "coreutils", "libc6"}, names)
        for package in packages.values():
            self.assertTrue(package["versionInfo"], package)

    @unittest.skipUnless(shutil.which("dpkg-query") and shutil.which("node"), "needs dpkg and node")
    def test_names_what_made_the_page(self):
        with tempfile.TemporaryDirectory() as folder:
            lock = os.path.join(folder, "package-lock.json")
            with open(lock, "w", encoding="utf-8") as file:
                json.dump({"packages": {"": {"name": "page"}, "node_modules/a/node_modules/@b/c": {
                    "version": "1.2.3", "license": "MIT", "integrity": "sha512-/+4="}}}, file)
            bill = json.loads(run(os.path.join(DEPLOY, "sbom.sh"), "lister", "1.2", "--npm", lock,
                                  "--tool", shutil.which("dpkg-query"), "/usr/bin/ls"))
        module = next(one for one in bill["packages"] if one["name"] == "@b/c")
        self.assertEqual((module["versionInfo"], module["licenseDeclared"],
                          module["checksums"][0]["checksumValue"],
                          module["externalRefs"][0]["referenceLocator"]),
                         ("1.2.3", "MIT", "ffee", "pkg:npm/%40b/c@1.2.3"))
        tools = {relation["spdxElementId"] for relation in bill["relationships"]
                 if relation["relationshipType"] == "BUILD_TOOL_OF"}
        named = {one["SPDXID"]: one["name"] for one in bill["packages"]}
        self.assertEqual({named[tool] for tool in tools}, {"@b/c", "dpkg"})


class Unit(unittest.TestCase):
    def setUp(self):
        if not shutil.which("systemd-analyze"):
            self.skipTest("systemd-analyze is not installed")

    def test_is_valid(self):
        with tempfile.TemporaryDirectory() as folder:
            unit = os.path.join(folder, "heliograph.service")
            with open(unit, "w", encoding="utf-8") as file:
                file.write(text_of(UNIT).replace("ExecStart=heliograph", "ExecStart=/bin/true"))
            said = subprocess.run(["systemd-analyze", "verify", unit], stdout=subprocess.PIPE,
                                  stderr=subprocess.STDOUT, text=True, timeout=60)
        self.assertEqual((said.returncode, said.stdout), (0, ""))

    def test_exposes_little(self):
        """systemd's exposure score, from 0 (none) to 10."""
        run("systemd-analyze", "security", "--offline=true", "--threshold=15", UNIT)


class Dockerfile(unittest.TestCase):
    text = text_of(os.path.join(DEPLOY, "Dockerfile"))

    def test_needs_no_downloaded_frontend(self):
        self.assertNotRegex(self.text, r"(?i)#\s*syntax\s*=")
        self.assertNotIn("<<", self.text)

    def test_context_excludes_tests_and_documents_only(self):
        kept = set(Checkout().files())
        committed = set(run("git", "-C", ROOT, "ls-tree", "-r", "--name-only",
                            "HEAD").splitlines())
        self.assertEqual({path for path in committed - kept
                          if not path.startswith(("tests/", ".ci/", "deploy/"))
                          and not path.endswith(".md")}, set())
        for path in ("deploy/packages", "deploy/setup.sh", "deploy/closure.sh", "deploy/sbom.sh",
                     "deploy/debian/postinst", "deploy/systemd/heliograph.service",
                     "deploy/CMakeLists.txt", "deploy/package_time.cmake.in",
                     "deploy/package_permissions.cmake", "LICENSE"):
            self.assertIn(path, kept)


if __name__ == "__main__":
    unittest.main()
