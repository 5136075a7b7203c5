"""Shared by the static tests."""

import glob
import os

import yaml

ROOT = os.path.normpath(os.path.join(os.path.dirname(os.path.abspath(__file__)), "../../.."))
DEPLOY = os.path.join(ROOT, "deploy")


def files(pattern, folder=DEPLOY):
    return sorted(glob.glob(os.path.join(folder, "**", pattern), recursive=True))


def text_of(path):
    with open(path, encoding="utf-8") as file:
        return file.read()


def documents(path):
    return [document for document in yaml.safe_load_all(text_of(path)) if document]


def server_sources():
    return "".join(text_of(path) for path in files("*.cpp", os.path.join(ROOT, "server")) +
                   files("*.hpp", os.path.join(ROOT, "server")))
