"""Sources of options, their precedence, and error messages."""

import os
import tempfile
import unittest
import unittest.mock

from test_operations import run

SECRET = "a-secret-0123456789"


class Config(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        surroundings = unittest.mock.patch.dict(os.environ)
        surroundings.start()
        self.addCleanup(surroundings.stop)
        # It would come before what the files of the tests say.
        os.environ.pop("HELIOGRAPH_SCENE_ROOT", None)

    def file(self, text, name="heliograph.toml"):
        path = os.path.join(self.folder.name, name)
        with open(path, "w", encoding="utf-8") as file:
            file.write(text)
        return path

    def effective(self, *arguments, environment=None):
        """What is in effect, and where from: {key: (value, source)}."""
        code, out, err = run("serve", "--print-config", *arguments, environment=environment)
        self.assertEqual(code, 0, err)
        values = {}
        for line in out.splitlines():
            if " = " in line and not line.startswith("#"):
                key, _, rest = line.partition(" = ")
                value, _, source = rest.partition("  # ")
                values[key] = (value, source)
        return values, out

    def refused(self, *arguments, environment=None, saying):
        code, out, err = run("serve", *arguments, environment=environment)
        self.assertEqual(code, 2, out + err)
        self.assertEqual(len(err.strip().splitlines()), 1, err)
        for part in saying:
            self.assertIn(part, err)

    def test_precedence_is_flag_environment_file_default(self):
        path = self.file("[serve]\nport = 1001\nmax-viewers = 11\nwidth = 111\n")
        environment = {"HELIOGRAPH_PORT": "1002", "HELIOGRAPH_MAX_VIEWERS": "12"}
        values, _ = self.effective("--config", path, "--port", "1003", environment=environment)
        self.assertEqual(values["port"], ("1003", "on the command line"))
        self.assertEqual(values["max-viewers"], ("12", "in HELIOGRAPH_MAX_VIEWERS"))
        self.assertEqual(values["width"], ("111", "in " + path))
        self.assertEqual(values["host"], ('"127.0.0.1"', ""))

    def test_the_path_of_the_file_can_come_from_the_environment(self):
        path = self.file("[serve]\nport = 1001\n")
        values, _ = self.effective(environment={"HELIOGRAPH_CONFIG": path})
        self.assertEqual(values["port"][0], "1001")
        other = self.file("[serve]\nport = 1004\n", "other.toml")
        values, _ = self.effective("--config=" + other, environment={"HELIOGRAPH_CONFIG": path})
        self.assertEqual(values["port"][0], "1004")

    def test_lists_flags_comments_and_other_commands(self):
        path = self.file('# all of it\nset = ["exposure.compensation=1"]\n[serve]\n'
                         'scene-root = ["/tmp", "/var/tmp"]   # two\ninsecure = true\n'
                         '[render]\nsamples = 5\n[health]\nurl = "http://127.0.0.1:1/"\n')
        values, _ = self.effective("--config", path)
        self.assertEqual(values["scene-root"][0], '["/tmp", "/var/tmp"]')
        self.assertEqual(values["insecure"][0], "true")
        self.assertIn("exposure.compensation=1", values["set"][0])
        code, _, err = run("health", "--config", path)
        self.assertEqual(code, 1)
        self.assertIn("http://127.0.0.1:1/", err)
        values, _ = self.effective(environment={"HELIOGRAPH_ALLOW_ORIGIN": "https://a.b,https://c"})
        self.assertEqual(values["allow-origin"][0], '["https://a.b", "https://c"]')

    def test_printed_configuration_can_be_read_back(self):
        first, out = self.effective("--port", "4711", "--set", "exposure.compensation=2",
                                    "--allow-origin", "https://a.b", "--insecure")
        again, _ = self.effective("--config", self.file(out))
        self.assertEqual({key: value for key, (value, _) in first.items()},
                         {key: value for key, (value, _) in again.items()})

    def test_secrets_are_not_printed(self):
        path = self.file(f'[serve]\ntoken = "{SECRET}"\n')
        _, out = self.effective("--config", path, "--view-token", "another-" + SECRET)
        self.assertNotIn(SECRET, out)
        self.assertIn("# token is given in " + path, out)
        self.assertIn("# view-token is given on the command line", out)

    def test_mistakes_name_file_key_and_limit(self):
        for line, parts in (("port = 70000", ("port", "65535")),
                            ("prot = 1", ("prot", "did you mean port")),
                            ('log-level = "loud"', ("log-level", "warning")),
                            ("max-viewers = 0", ("max-viewers", "1 to 1000")),
                            ("width = wide", ("width", "16384"))):
            path = self.file("[serve]\n" + line + "\n")
            self.refused("--config", path, saying=(path, *parts))
        path = self.file("[serv]\nport = 1\n")
        self.refused("--config", path, saying=(path, "serv"))
        self.refused("--config", path + "x", saying=(path + "x", "cannot read"))
        self.refused(environment={"HELIOGRAPH_PORT": "70000"}, saying=("HELIOGRAPH_PORT", "65535"))

    def test_help_is_grouped_and_names_every_variable(self):
        code, out, _ = run("serve", "--help")
        self.assertEqual(code, 0)
        for group in ("Network:", "Access:", "Capacity:", "Scenes:", "Frames:", "Device:", "Log:"):
            self.assertIn(group, out)
        lines = [line.strip() for line in out.splitlines()]
        options = [line for line in lines if line.startswith("--") and " " in line]
        self.assertGreater(len(options), 30)
        for line in options:
            if not line.startswith("--print-config"):
                name = line.split()[0][2:].replace("-", "_").upper()
                self.assertIn("HELIOGRAPH_" + name, line)
