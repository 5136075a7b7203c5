"""Static checks of the Kubernetes objects."""

import os
import re
import tempfile
import unittest

from harness import kubernetes
from harness.files import DEPLOY, ROOT, documents, files, text_of

# An autoscaler does not act while a metric is within a tenth of its target.
TOLERANCE = 1.1
# Reserved for documentation (RFC 5737).
UNUSED_RANGE = "192.0.2.0/24"


def number_in(path, pattern):
    return int(re.search(pattern, text_of(os.path.join(ROOT, path))).group(1).replace("_", ""))


def environment_of(deployment):
    container, = deployment["spec"]["template"]["spec"]["containers"]
    return {entry["name"]: entry.get("value") for entry in container["env"]}


class Objects(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.objects = kubernetes.objects()

    def one(self, kind, name="heliograph"):
        return kubernetes.one(self.objects, kind, name)

    def pod(self):
        return self.one("Deployment")["spec"]["template"]

    def test_every_file_is_applied(self):
        listed = set()
        for folder in ("", *kubernetes.COMPONENTS):
            found = kubernetes.kustomization(folder)
            names = found.get("resources", []) + [p["path"] for p in found.get("patches", [])]
            listed |= {os.path.join(kubernetes.FOLDER, folder, name) for name in names}
        present = {path for path in files("*.yaml", kubernetes.FOLDER)
                   if not path.endswith("/kustomization.yaml")}
        self.assertEqual(present, listed)

    def test_selectors_find_the_pods(self):
        labels = self.pod()["metadata"]["labels"].items()
        selectors = [o["spec"]["selector"].get("matchLabels", o["spec"]["selector"])
                     for o in self.objects if "selector" in o.get("spec", {})]
        selectors.append(self.one("NetworkPolicy")["spec"]["podSelector"]["matchLabels"])
        self.assertEqual(len(selectors), 5)
        for selector in selectors:
            self.assertLessEqual(selector.items(), labels)

    def test_ports_are_those_of_the_container(self):
        container, = self.pod()["spec"]["containers"]
        names = {port["name"]: port["containerPort"] for port in container["ports"]}
        listen = environment_of(self.one("Deployment"))["HELIOGRAPH_METRICS_LISTEN"]
        self.assertTrue(listen.endswith(f":{names['metrics']}"))
        for service in (o for o in self.objects if o["kind"] == "Service"):
            for port in service["spec"]["ports"]:
                self.assertIn(port["targetPort"], names)
        for probe in ("startupProbe", "readinessProbe", "livenessProbe"):
            self.assertIn(container[probe]["httpGet"]["port"], names)
        path, = self.one("Ingress")["spec"]["rules"][0]["http"]["paths"]
        asked = path["backend"]["service"]
        service = self.one("Service", asked["name"])["spec"]
        self.assertIn(asked["port"]["name"], [port["name"] for port in service["ports"]])

    def test_pods_are_restricted(self):
        """The profile "restricted" of the pod security standards, which their namespace enforces,
        and a read-only root."""
        namespace = self.one("Namespace", kubernetes.kustomization()["namespace"])
        labels = namespace["metadata"]["labels"]
        self.assertEqual(labels["pod-security.kubernetes.io/enforce"], "restricted")
        spec = self.pod()["spec"]
        self.assertTrue(spec["securityContext"]["runAsNonRoot"])
        self.assertEqual(spec["securityContext"]["seccompProfile"]["type"], "RuntimeDefault")
        self.assertFalse(spec["automountServiceAccountToken"])
        for container in spec["containers"] + spec["initContainers"]:
            with self.subTest(container["name"]):
                context = container["securityContext"]
                self.assertFalse(context["allowPrivilegeEscalation"])
                self.assertTrue(context["readOnlyRootFilesystem"])
                self.assertEqual(context["capabilities"], {"drop": ["ALL"]})
                self.assertIn("memory", container["resources"]["limits"])
        self.assertLessEqual({tuple(volume)[1] for volume in spec["volumes"]}, {"emptyDir"})

    def test_every_shard_of_a_manifest_has_a_pod(self):
        job = self.one("Job", "heliograph-render")["spec"]
        container, = job["template"]["spec"]["containers"]
        self.assertEqual(job["completionMode"], "Indexed")
        self.assertIn(f'--shard "$((JOB_COMPLETION_INDEX + 1))/{job["completions"]}"', container["args"][0])
        self.assertEqual(container["securityContext"], self.pod()["spec"]["containers"][0]["securityContext"])
        self.assertEqual(job["template"]["spec"]["securityContext"], self.pod()["spec"]["securityContext"])

    def test_the_same_user_as_in_the_image(self):
        user = re.search(r"(?m)^USER (\d+):", text_of(os.path.join(DEPLOY, "Dockerfile"))).group(1)
        self.assertEqual(self.pod()["spec"]["securityContext"]["runAsUser"], int(user))

    def test_grace_period_covers_the_shutdown(self):
        pod = self.pod()["spec"]
        pause = int(pod["containers"][0]["lifecycle"]["preStop"]["exec"]["command"][1])
        self.assertGreaterEqual(pod["terminationGracePeriodSeconds"], pause + 20)

    def test_no_proxy_is_trusted_without_an_ingress(self):
        self.assertNotIn("HELIOGRAPH_TRUST_PROXY", environment_of(self.one("Deployment")))
        patch, = documents(os.path.join(kubernetes.FOLDER, "ingress/trusted-proxy.yaml"))
        self.assertEqual(environment_of(patch), {"HELIOGRAPH_TRUST_PROXY": UNUSED_RANGE})

    def test_the_device_plugin_assigns_the_gpu(self):
        patch, = documents(os.path.join(kubernetes.FOLDER, "gpu/deployment.yaml"))
        for deployment in (self.one("Deployment"), patch):
            self.assertNotIn("NVIDIA_VISIBLE_DEVICES", environment_of(deployment))
        container, = patch["spec"]["template"]["spec"]["containers"]
        self.assertEqual(container["resources"]["limits"], {"nvidia.com/gpu": 1})
        self.assertGreaterEqual(int(environment_of(patch)["HELIOGRAPH_MAX_PIXELS"]),
                                8 * 1920 * 1080)

    def test_resources_of_components_are_in_the_namespace(self):
        """The base's kustomization does not set it for components."""
        for folder in kubernetes.COMPONENTS:
            for name in kubernetes.kustomization(folder).get("resources", []):
                for brought in documents(os.path.join(kubernetes.FOLDER, folder, name)):
                    with self.subTest(name):
                        self.assertEqual(brought["metadata"].get("namespace"),
                                         kubernetes.kustomization()["namespace"])


class Scaling(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.objects = kubernetes.objects()
        cls.scaler = kubernetes.one(cls.objects, "HorizontalPodAutoscaler")["spec"]
        cls.targets = {m["pods"]["metric"]["name"]: m["pods"]["target"]["averageValue"]
                       for m in cls.scaler["metrics"]}

    def test_only_the_autoscaler_sets_the_number_of_pods(self):
        deployment = kubernetes.one(self.objects, "Deployment")
        self.assertEqual(self.scaler["scaleTargetRef"]["name"], deployment["metadata"]["name"])
        self.assertNotIn("replicas", deployment["spec"])
        budget = kubernetes.one(self.objects, "PodDisruptionBudget")["spec"]
        self.assertLess(budget["maxUnavailable"], self.scaler["minReplicas"])

    def test_it_acts_while_another_browser_fits(self):
        most = number_in("web_client/src/app/main.ts", r"softwarePixels = ([\d_]+)")
        limit = int(environment_of(kubernetes.one(self.objects, "Deployment"))
                    ["HELIOGRAPH_MAX_PIXELS"])
        target = self.targets["heliograph_session_pixels_share"]
        self.assertRegex(target, r"^\d+m$")
        acts_at = TOLERANCE * int(target[:-1]) / 1000
        self.assertLessEqual(acts_at * limit + most, limit)
        least = self.scaler["minReplicas"]
        self.assertLessEqual(acts_at * least / (least - 1), 1, "no room if a node fails")

    def test_it_acts_before_a_session_is_full_of_viewers(self):
        most = number_in("server/cli/options.hpp", r"max_viewers = (\d+);")
        self.assertLess(TOLERANCE * int(self.targets["heliograph_viewers"]), most)

    def test_the_documented_adapter_provides_its_metrics(self):
        given = {rule.get("name", {}).get("as") or rule["seriesQuery"].split("{")[0]
                 for rule in kubernetes.adapter_rules()}
        self.assertEqual(set(self.targets), given)


class Overlay(unittest.TestCase):
    """The documented overlay, rendered by kubectl."""

    @classmethod
    def setUpClass(cls):
        folder = cls.enterClassContext(tempfile.TemporaryDirectory())
        cls.objects = kubernetes.rendered_overlay(folder)

    def test_has_everything(self):
        """Except the job, which is applied when there is a manifest to render."""
        expected = [o for o in kubernetes.objects() if o["kind"] != "Job"]
        self.assertEqual(sorted((o["kind"], o["metadata"]["name"]) for o in self.objects),
                         sorted((o["kind"], o["metadata"]["name"]) for o in expected))

    def test_everything_is_in_the_namespace(self):
        for found in self.objects:
            with self.subTest(f"{found['kind']} {found['metadata']['name']}"):
                self.assertEqual(found["metadata"].get("namespace"),
                                 None if found["kind"] == "Namespace" else "heliograph")

    def test_uses_the_registry_for_every_image(self):
        spec = kubernetes.one(self.objects, "Deployment")["spec"]["template"]["spec"]
        self.assertEqual({container["image"]
                          for container in spec["containers"] + spec["initContainers"]},
                         {"registry.example.org/heliograph:0.1.0"})

    def test_only_the_ingress_reaches_the_server_that_trusts_it(self):
        policy = kubernetes.one(self.objects, "NetworkPolicy")["spec"]
        comes_from = {port["port"]: [peer["namespaceSelector"]["matchLabels"]
                                     for peer in rule["from"]]
                      for rule in policy["ingress"] for port in rule["ports"]}
        label = "kubernetes.io/metadata.name"
        self.assertEqual(comes_from, {"http": [{label: "ingress-nginx"}],
                                      "metrics": [{label: "monitoring"}]})
        self.assertEqual(policy["policyTypes"], ["Ingress", "Egress"])

    def test_contains_components_and_overlay(self):
        deployment = kubernetes.one(self.objects, "Deployment")
        environment = environment_of(deployment)
        self.assertEqual(environment["HELIOGRAPH_TRUST_PROXY"], "10.244.0.0/16")
        self.assertEqual(environment["HELIOGRAPH_MAX_PIXELS"], "16600000")
        self.assertIn("HELIOGRAPH_METRICS_LISTEN", environment)
        self.assertIn("VK_DRIVER_FILES", environment)
        # If every GPU is in use, an additional pod would never start.
        self.assertEqual(deployment["spec"]["strategy"],
                         {"type": "RollingUpdate",
                          "rollingUpdate": {"maxSurge": 0, "maxUnavailable": 1}})
        spec = deployment["spec"]["template"]["spec"]
        self.assertEqual(spec["runtimeClassName"], "nvidia")
        self.assertEqual(spec["containers"][0]["resources"]["limits"],
                         {"cpu": "2", "memory": "2Gi", "nvidia.com/gpu": 1})
        self.assertNotIn("heliograph.example.org",
                         str(kubernetes.one(self.objects, "Ingress")["spec"]))


if __name__ == "__main__":
    unittest.main()
