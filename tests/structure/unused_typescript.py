#!/usr/bin/env python3
"""Checks that every export of the web client and its library is needed: another file imports it,
or a test imports it and its own file uses it."""

import pathlib
import re
import sys

from sources import ROOT, report

CLIENT = ROOT / "web_client/src"
TESTS = ROOT / "web_client/tests"
LIBRARY = ROOT / "protocol/typescript"
# Public interface of the library that the web client does not use. None: the whole file.
PUBLIC = {
    "client.ts": {"HeliographClient", "ClientOptions"},
    "local.ts": None,
    "messages.ts": None,
    "settings_schema.ts": {"ToggleControl", "TextControl", "ColorControl", "JsonControl"},
}
EXPORT = re.compile(r"^export (?:declare )?(?:abstract )?(?:async )?"
                    r"(?:const|let|function|class|interface|type|enum) (\w+)", re.MULTILINE)
IMPORT = re.compile(r'\bimport\s+(?:type\s+)?\{([^}]*)\}\s+from\s+"([^"]+)"')
COMMENT = re.compile(r"//[^\n]*|/\*.*?\*/", re.DOTALL)


def imported_file(path, target):
    if target.startswith("heliograph/"):
        return LIBRARY / target.removeprefix("heliograph/")
    return (path.parent / target).resolve()


def imports_of(files):
    """Pairs of a file and a name that other files import from it."""
    for path in files:
        for names, target in IMPORT.findall(path.read_text()):
            source = imported_file(path, target)
            for name in names.split(","):
                yield source, name.split(" as ")[0].strip().removeprefix("type ")


def is_public(path, name):
    names = PUBLIC.get(path.name, ()) if path.parent == LIBRARY else ()
    return names is None or name in names


def is_used_inside(path, name):
    return len(re.findall(rf"\b{name}\b", COMMENT.sub("", path.read_text()))) > 1


files = [*CLIENT.rglob("*.ts"), *LIBRARY.glob("*.ts")]
exports = [(path, name) for path in files for name in EXPORT.findall(path.read_text())]
used = set(imports_of(files))
used |= {one for one in imports_of(TESTS.rglob("*.ts")) if is_used_inside(*one)}
unused = [f"{path.relative_to(ROOT)}: {name} is exported without need"
          for path, name in exports if (path, name) not in used and not is_public(path, name)]
sys.exit(report(files, 60, unused, f"all {len(exports)} exports are needed"))
