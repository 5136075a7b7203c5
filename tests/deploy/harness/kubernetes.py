"""The Kubernetes objects, from their files and rendered by an overlay."""

import json
import os
import re
import shutil

import yaml

from .commands import OutOfReach, run
from .files import DEPLOY, ROOT, documents, text_of

FOLDER = os.path.join(DEPLOY, "kubernetes")
COMPONENTS = ("gpu", "ingress", "render")


def kustomization(folder=""):
    return documents(os.path.join(FOLDER, folder, "kustomization.yaml"))[0]


def objects():
    """All applied objects, components included, without the components' patches."""
    return [document for folder in ("", *COMPONENTS)
            for name in kustomization(folder).get("resources", [])
            for document in documents(os.path.join(FOLDER, folder, name))]


def one(listed, kind, name="heliograph"):
    found, = [o for o in listed if o["kind"] == kind and o["metadata"]["name"] == name]
    return found


def examples():
    """The YAML blocks of the documentation, as text."""
    blocks = re.findall(r"(?ms)^```\n(.*?)^```$", text_of(os.path.join(DEPLOY, "README.md")))
    return [block for block in blocks if re.match(r"(#.*\n)?\w+:( |\n)", block)]


def adapter_rules():
    """The documented rules of prometheus-adapter."""
    rules, = [block for block in examples() if block.startswith("rules:")]
    return yaml.safe_load(rules)["rules"]


def rendered_overlay(folder):
    """The documented overlay as rendered by kubectl; `folder` must be empty."""
    overlay, = [block for block in examples() if "\ncomponents:" in block]
    checkout = os.path.relpath(os.path.realpath(ROOT), os.path.realpath(folder))
    with open(os.path.join(folder, "kustomization.yaml"), "w", encoding="utf-8") as file:
        file.write(overlay.replace("heliograph/deploy", f"{checkout}/deploy"))
    return [o for o in yaml.safe_load_all(run(_kubectl(), "kustomize", folder)) if o]


def _kubectl():
    found = shutil.which("kubectl", path="/usr/bin:/usr/sbin:" + os.environ.get("PATH", ""))
    version = run(found, "version", "--client", "--output=json") if found else "{}"
    if "kustomizeVersion" not in json.loads(version):
        raise OutOfReach("kubectl with components (1.21), which not every distribution has")
    return found
