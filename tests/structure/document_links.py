#!/usr/bin/env python3
"""Checks what the documents (*.md) refer to: relative links and their anchors, repository paths,
classes, functions and test names in backticks. A renamed file or function must be renamed in the
documents too."""

import fnmatch
import functools
import pathlib
import re
import sys

from sources import ROOT, report, tracked

SOURCE_FOLDERS = ("protocol", "server", "shaders", "web_client/src", "tests", "scenes/generator")
SOURCE_SUFFIXES = {".cpp", ".hpp", ".h", ".def", ".comp", ".glsl", ".py", ".ts", ".mjs"}
# A code span with one of these suffixes is a file even without a folder in front of it.
FILE_SUFFIXES = SOURCE_SUFFIXES | {".md", ".sh", ".yaml", ".yml", ".cfg", ".def", ".cmake"}
# Names of files in examples, which are not part of the repository.
EXAMPLE_FILES = {"private-ca.pem", "daemon.json", "config.toml"}

FENCE = re.compile(r"^(```|~~~).*?^\1\s*$", re.MULTILINE | re.DOTALL)
CODE = re.compile(r"`([^`\n]+)`")
LINK = re.compile(r"!?\[[^\]]*\]\(([^)\s]+)\)")
HEADING = re.compile(r"^#+\s+(.*?)\s*$", re.MULTILINE)
PATH = re.compile(r"[\w.*{},-]+(/[\w.*{},-]+)*/?")
PLACEHOLDER = re.compile(r"[A-Z]{3,}")
MEMBER = re.compile(r"([A-Za-z]\w*(?:::~?\w+)+)(\(.*\))?")
CALL = re.compile(r"([a-z]\w*(?:_\w+)+)\(\)")
TEST_NAME = re.compile(r"([A-Z]\w+)\.([A-Z]\w{4,})")


@functools.cache
def all_files():
    return tuple(tracked("*"))


@functools.cache
def file_names():
    return {path.name for path in all_files()}


@functools.cache
def source_text():
    tops = tuple(ROOT / folder for folder in SOURCE_FOLDERS)
    return "\n".join(path.read_text(errors="replace") for path in all_files()
                     if path.suffix in SOURCE_SUFFIXES
                     and any(path.is_relative_to(top) for top in tops))


@functools.cache
def words():
    return set(re.findall(r"\w+", source_text()))


@functools.cache
def test_names():
    found = re.findall(r"\bT(?:YPED_T)?EST(?:_[FP])?\(\s*(\w+),\s*(\w+)\)", source_text())
    return {f"{suite}.{name}" for suite, name in found}


def slug(heading: str) -> str:
    """The anchor that GitHub generates for a heading."""
    text = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", heading).replace("`", "").lower()
    return re.sub(r"[^\w\- ]", "", text).replace(" ", "-")


@functools.cache
def anchors(path: pathlib.Path):
    return {slug(heading) for heading in HEADING.findall(FENCE.sub("", path.read_text()))}


def link_fault(document: pathlib.Path, target: str):
    if re.match(r"[a-z]+:", target):
        return None
    name, _, anchor = target.partition("#")
    path = (document.parent / name).resolve() if name else document
    if not path.exists():
        return f"the link {target} leads nowhere"
    if anchor and path.suffix == ".md" and anchor not in anchors(path):
        return f"{name or document.name} has no heading for #{anchor}"
    return None


def expand(text: str):
    """"a.{hpp,cpp}" -> "a.hpp", "a.cpp"; placeholders such as NAME become *."""
    match = re.search(r"\{([^{}]*)\}", text)
    if match:
        for choice in match.group(1).split(","):
            yield from expand(text[:match.start()] + choice + text[match.end():])
    else:
        yield PLACEHOLDER.sub("*", text)


def exists(document: pathlib.Path, path: str) -> bool:
    for base in (ROOT, document.parent):
        if "*" in path:
            if any(True for _ in base.glob(path.rstrip("/"))):
                return True
        elif (base / path).exists():
            return not path.endswith("/") or (base / path).is_dir()
    return "/" not in path and any(fnmatch.fnmatchcase(name, path) for name in file_names())


def path_fault(document: pathlib.Path, code: str):
    if not PATH.fullmatch(code) or code in EXAMPLE_FILES or code.startswith(("build/", "build-")):
        return None
    first = code.split("/")[0]
    local = (document.parent / first).is_dir() and document.parent != ROOT
    in_folder = "/" in code and ((ROOT / first).is_dir() or local)
    is_file = "/" not in code and pathlib.PurePath(code).suffix in FILE_SUFFIXES and code[0] != "."
    if not in_folder and not is_file:
        return None
    missing = [path for path in expand(code) if not exists(document, path)]
    return f"`{code}`: there is no {missing[0]}" if missing else None


def name_fault(code: str):
    if match := TEST_NAME.fullmatch(code):
        return None if code in test_names() else f"`{code}`: there is no such test"
    match = MEMBER.fullmatch(code) or CALL.fullmatch(code)
    if not match or match.group(1).startswith("std::"):
        return None
    unknown = [part for part in re.split(r"::~?", match.group(1))
               if part not in words() and not PLACEHOLDER.fullmatch(part)]
    return f"`{code}`: nothing in the sources is called {unknown[0]}" if unknown else None


def faults(document: pathlib.Path):
    # Fenced blocks are examples; blanked, so that the numbers of lines stay.
    text = FENCE.sub(lambda block: "\n" * block.group().count("\n"), document.read_text())
    for number, line in enumerate(text.splitlines(), 1):
        found = [link_fault(document, target) for target in LINK.findall(CODE.sub("", line))]
        for code in CODE.findall(line):
            found.append(path_fault(document, code) or name_fault(code))
        for fault in filter(None, found):
            yield f"{document.relative_to(ROOT)}:{number}: {fault}"


documents = [path for path in all_files() if path.suffix == ".md"]
sys.exit(report(documents, 10, [fault for document in documents for fault in faults(document)],
                "every reference exists"))
