#!/usr/bin/env python3
"""Checks that what a header declares is used: a function or type at namespace level by another unit
(a .cpp with its .hpp), by its own and a test, or by tests alone where the comment above it
says "for tests"; a member function anywhere."""

import collections
import re
import sys

from sources import ROOT, report, sources

COMMENT_OR_TEXT = re.compile(r'//[^\n]*|/\*.*?\*/|"(?:\\.|[^"\\\n])*"', re.DOTALL)
NAME = re.compile(r"[A-Za-z_]\w*")
DECLARATION = (r"(?!return\b|if\b|for\b|while\b|switch\b|using\b|else\b|throw\b|friend\b|#)"
               r"(?:template <[^>]*>\s*)?[\w:<>,&*\s\[\]]*?[\w>&*\]]\s[&*]?([a-z]\w*)\([^;{]*[;{]")
FREE_FUNCTION = re.compile(r"^(?=\w)" + DECLARATION, re.MULTILINE)  # namespaces are not indented
MEMBER_FUNCTION = re.compile(r"^  (?=\w)" + DECLARATION, re.MULTILINE)
TYPE = re.compile(r"^(?:enum class|struct|class) ([A-Z]\w*)[^;\n]*\{", re.MULTILINE)
# Called by the language or by a library through their name.
CALLED_BY_NAME = {"main", "begin", "end", "size", "swap", "what", "fields", "operator"}


def without_comments(text):
    return COMMENT_OR_TEXT.sub(" ", text)


users = [p for p in sources("protocol", "server", "scenes", "tests", "shaders", "web_client")]
texts = {path: without_comments(path.read_text()) for path in users}
unit_of = {path: path.with_suffix("") for path in users}
used_in = collections.defaultdict(set)
for path, text in texts.items():
    for name in set(NAME.findall(text)):
        used_in[name].add(unit_of[path])

headers = [p for p in sources("protocol", "server", "scenes") if p.suffix == ".hpp"]
program = [p for p in users if p.relative_to(ROOT).parts[0] != "tests"]
program_units = {unit_of[p] for p in program}
faults = []
for path in headers:
    own = texts.get(path.with_suffix(".cpp"), "")
    inside = collections.Counter(NAME.findall(texts[path] + own))
    header = collections.Counter(NAME.findall(texts[path]))
    exported = set(FREE_FUNCTION.findall(texts[path])) | set(TYPE.findall(texts[path]))
    place = path.relative_to(ROOT)
    for name in sorted(exported - CALLED_BY_NAME):
        elsewhere = used_in[name] - {unit_of[path]}
        used_inside = inside[name] > (2 if own else 1)
        if elsewhere & program_units or header[name] > 1 or (elsewhere and used_inside):
            continue
        if elsewhere and re.search(r"for tests[^;]*?\b" + name, path.read_text(), re.DOTALL):
            continue
        if elsewhere:
            faults.append(f"{place}: only tests use {name}")
        elif used_inside:
            faults.append(f"{place}: {name} is used in its own .cpp only: declare it there")
        else:
            faults.append(f"{place}: nothing uses {name}")
    for name in sorted(set(MEMBER_FUNCTION.findall(texts[path])) - exported - CALLED_BY_NAME):
        defined_apart = bool(re.search(rf"\b{name}\b", own))
        if not used_in[name] - {unit_of[path]} and inside[name] <= 1 + defined_apart:
            faults.append(f"{place}: nothing uses {name}")
sys.exit(report(headers, 150, faults, "everything that headers declare is used"))
