"""Static checks of scrape configuration, alerts and dashboards."""

import json
import os
import re
import shutil
import tempfile
import unittest

from harness import kubernetes
from harness.commands import run
from harness.files import DEPLOY, ROOT, documents, files, text_of

HERE = os.path.dirname(os.path.abspath(__file__))
RULES = os.path.join(HERE, "prometheus/alerts_test.yml")
NAME = r"\b(?:heliograph|process)_[a-z_]*[a-z]\b"


def taken():
    """Every series of the server, from the one file that writes them."""
    text = text_of(os.path.join(ROOT, "server/net/http/metrics.cpp"))
    kinds = [(name, kind) for kind, name in
             re.findall(rf'page\.(counter|gauge|histogram)\(\s*"({NAME})"', text)]
    kinds += re.findall(rf'page\.describe\(\s*"({NAME})",\s*"[^"]*",\s*"(\w+)"', text)
    kinds += re.findall(rf'each\("({NAME})",\s*"[^"]*",\s*"(\w+)"', text)
    return {name + end for name, kind in kinds
            for end in (("_bucket", "_sum", "_count") if kind == "histogram" else ("",))}


def boards():
    return files("*.json", os.path.join(DEPLOY, "grafana"))


def expressions(board):
    return [target["expr"] for panel in json.loads(text_of(board))["panels"]
            for target in panel.get("targets", [])]


class Names(unittest.TestCase):
    known = taken()

    def check(self, path, text, least=1):
        shown = set(re.findall(NAME, text))
        self.assertGreaterEqual(len(shown), least, path)
        for name in shown:
            with self.subTest(f"{os.path.basename(path)}: {name}"):
                self.assertIn(name, self.known)

    def test_are_parsed(self):
        self.assertGreater(len(self.known), 40)
        self.assertLessEqual({"heliograph_ready", "heliograph_render_seconds_sum",
                              "heliograph_pass_seconds_bucket", "heliograph_memory_limit_bytes",
                              "process_cpu_seconds_total"}, self.known)
        self.assertNotIn("heliograph_render_seconds", self.known)

    def test_of_dashboards_exist(self):
        for path in boards():
            self.check(path, "\n".join(expressions(path)), least=10)

    def test_of_alerts_exist(self):
        path = os.path.join(DEPLOY, "prometheus/alerts.yml")
        rules = [rule["expr"] for group in documents(path)[0]["groups"] for rule in group["rules"]]
        self.check(path, "\n".join(rules), least=8)
        self.check(RULES, "\n".join(re.findall(r"series: '(.*?)'", text_of(RULES))), least=8)

    def test_of_the_autoscaler_exist(self):
        """Through the adapter's rules, which may rename them."""
        for rule in kubernetes.adapter_rules():
            self.check("the adapter", rule["seriesQuery"])
            self.check("the adapter", rule["metricsQuery"])

    def test_of_the_documentation_exist(self):
        path = os.path.join(DEPLOY, "README.md")
        text = text_of(path)
        derived = {rule["name"]["as"] for rule in kubernetes.adapter_rules() if "name" in rule}
        # The name of a histogram stands for all its series.
        known = self.known | derived | {re.sub("_bucket$", "", name) for name in self.known}
        self.assertEqual(sorted(set(re.findall(NAME, text)) - known), [])


class Alerts(unittest.TestCase):
    def test_each_is_tested_firing_and_silent(self):
        groups = documents(os.path.join(DEPLOY, "prometheus/alerts.yml"))[0]["groups"]
        named = {rule["alert"] for group in groups for rule in group["rules"]}
        seen = {True: set(), False: set()}
        for test in documents(RULES)[0]["tests"]:
            for check in test["alert_rule_test"]:
                seen[bool(check["exp_alerts"])].add(check["alertname"])
        self.assertEqual((named - seen[True], named - seen[False]), (set(), set()))

    def test_are_tested_with_the_limits_of_the_manifests(self):
        container, = kubernetes.one(kubernetes.objects(), "Deployment")["spec"]["template"][
            "spec"]["containers"]
        pixels, = [entry["value"] for entry in container["env"]
                   if entry["name"] == "HELIOGRAPH_MAX_PIXELS"]
        limits = re.findall(r"heliograph_session_pixels_limit\{.*values: '(\d+)", text_of(RULES))
        self.assertEqual(set(limits), {pixels})


class Promtool(unittest.TestCase):
    """If promtool is installed; the image checks its configuration while it is built."""

    def promtool(self, *words):
        found = shutil.which("promtool", path="/usr/bin:/usr/sbin")
        if not found:
            self.skipTest("promtool is not installed")
        return run(found, *words)

    def test_the_configuration_is_valid(self):
        self.promtool("check", "config", os.path.join(DEPLOY, "prometheus/prometheus.yml"))

    def test_alerts_fire_when_they_should(self):
        with tempfile.TemporaryDirectory() as folder:
            for path in (os.path.join(DEPLOY, "prometheus/alerts.yml"), RULES):
                shutil.copy(path, folder)
            self.promtool("test", "rules", os.path.join(folder, "alerts_test.yml"))


class Dashboards(unittest.TestCase):
    def test_use_the_provisioned_data_source(self):
        source, = documents(os.path.join(DEPLOY, "grafana/provisioning/datasources/"
                                                 "prometheus.yaml"))[0]["datasources"]
        for path in boards():
            panels = json.loads(text_of(path))["panels"]
            self.assertGreater(len(panels), 3)
            self.assertEqual(len({panel["id"] for panel in panels}), len(panels))
            for panel in panels:
                if panel["type"] == "row":
                    continue
                with self.subTest(panel["title"]):
                    self.assertEqual(panel["datasource"]["uid"], source["uid"])
                    self.assertTrue(all(target["expr"] for target in panel["targets"]))


if __name__ == "__main__":
    unittest.main()
