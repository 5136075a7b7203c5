#!/usr/bin/env python3
"""Checks the table of methods in protocol/README.md against the Python methods, which are generated
from the server's description: names, parameters and, where the table lists them, members of results."""

import ast
import re
import sys

from sources import ROOT, report

GENERATED = ROOT / "protocol/python/heliograph/methods.py"
README = ROOT / "protocol/README.md"
MEMBER = re.compile(r"[a-z]\w*")


def members(text):
    """"a, b" -> {"a", "b"}; None where the text is prose."""
    names = [name.strip() for name in text.split(",") if name.strip()]
    return set(names) if names and all(map(MEMBER.fullmatch, names)) else None


def generated_methods():
    """Method -> (parameters, members of its result)."""
    methods = {}
    for group in ast.parse(GENERATED.read_text()).body:
        if not isinstance(group, ast.ClassDef) or group.name == "_Group":
            continue
        for function in group.body:
            if not isinstance(function, ast.FunctionDef) or function.name.startswith("_"):
                continue
            called = re.search(r'_call\("([\w.]+)"', ast.unparse(function).replace("'", '"'))
            result = re.search(r"(?:Gives|Returns): (.*?)\.$", ast.get_docstring(function) or "",
                               re.DOTALL | re.MULTILINE)
            names = {argument.arg for argument in function.args.kwonlyargs}
            methods[called.group(1)] = (names, members(result.group(1).replace("\n", " "))
                                        if result else set())
    return methods


def documented_methods():
    """(method, parameters, result) of every row; one row may name several methods."""
    for row in re.findall(r"(?m)^\| (`\w[^|]*) \|([^|]*)\|([^|]*)\|$", README.read_text()):
        for name in re.findall(r"`([a-z]+(?:\.[a-z]+)?)`", row[0]):
            yield name, row[1], row[2]


def faults():
    generated = generated_methods()
    documented = [row for row in documented_methods() if row[0] in generated]
    for missing in sorted(set(generated) - {name for name, *_ in documented}):
        yield f"protocol/README.md: the method {missing} is missing"
    for name, parameters, result in documented:
        in_code = generated[name]
        if (members(parameters) or set()) != in_code[0]:
            yield f"protocol/README.md: {name} takes {', '.join(sorted(in_code[0])) or 'nothing'}"
        listed = members(result)
        # A single word may be prose, such as "nothing".
        if listed and len(listed) > 1 and listed != in_code[1]:
            yield f"protocol/README.md: {name} returns {', '.join(sorted(in_code[1]))}"


sys.exit(report(list(generated_methods()), 40, list(faults()), "methods are documented as they are"))
