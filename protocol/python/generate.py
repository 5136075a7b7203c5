#!/usr/bin/env python3
"""Generates heliograph/methods.py from the server's description of the protocol:

    heliograph schema | protocol/python/generate.py > protocol/python/heliograph/methods.py
"""

import json
import keyword
import pathlib
import sys
import textwrap

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "generator"))
from description import kinds_of, read_openrpc, sentence, with_unit  # noqa: E402

HEAD = '''"""Every method of heliograph.v1, made by generate.py from `heliograph schema`."""

from typing import Any, Dict, List, Literal, Optional, Union

_UNSET: Any = type("Unset", (), {"__repr__": lambda self: "..."})()


def _given(params):
    return {name: value for name, value in params.items() if value is not _UNSET}


class _Group:
    def __init__(self, call):
        self._call = call
'''

SIMPLE = {"boolean": "bool", "integer": "int", "number": "float", "string": "str",
          "object": "Dict[str, Any]"}


def python_type(schema):
    kinds, nullable = kinds_of(schema)
    if nullable or len(kinds) > 1:
        types = [python_type({**schema, "type": kind}) for kind in kinds]
        joined = types[0] if len(types) == 1 else f"Union[{', '.join(types)}]"
        return f"Optional[{joined}]" if nullable else joined
    if "enum" in schema:
        return "Literal[" + ", ".join(json.dumps(value) for value in schema["enum"]) + "]"
    if kinds == ["array"]:
        return f"List[{python_type(schema.get('items', {}))}]"
    return SIMPLE[kinds[0]]


def docstring(method, indent):
    lines = [sentence(method["summary"]), ""]
    for param in method["params"]:
        text = f"{param['name']}: {with_unit(param['description'], param['schema'])}"
        lines += textwrap.wrap(text, 96 - indent, subsequent_indent="    ")
    results = method["result"]["schema"].get("properties", {})
    if results:
        if method["params"]:
            lines.append("")
        text = "Gives: " + ", ".join(results) + "."
        lines += textwrap.wrap(text, 96 - indent, subsequent_indent="    ")
    lines = textwrap.wrap(lines[0], 93 - indent) + lines[1:]
    while not lines[-1]:
        lines.pop()
    if len(lines) == 1:
        return [f'"""{lines[0]}"""']
    return [f'"""{lines[0]}', *lines[1:], '"""']


def function(method, name, indent):
    pad = " " * indent
    arguments = ["self"]
    params = method["params"]
    if params:
        arguments.append("*")
    for param in params:
        initial = "" if param["required"] else " = _UNSET"
        arguments.append(f"{param['name']}: {python_type(param['schema'])}{initial}")
    returns = python_type(method["result"]["schema"])
    head = f"def {name}({', '.join(arguments)}) -> {returns}:"
    if len(pad + head) > 100:
        body = ",\n".join(pad + " " * 8 + argument for argument in arguments)
        head = f"def {name}(\n{body}) -> {returns}:"
    lines = [pad + head]
    lines += [(pad + "    " + line).rstrip() for line in docstring(method, indent + 4)]
    members = ", ".join(f'"{param["name"]}": {param["name"]}' for param in params)
    call = f'return self._call("{method["name"]}", '
    if not params:
        lines.append(f"{pad}    {call}{{}})")
    elif len(pad + call + members) < 85:
        lines.append(f"{pad}    {call}_given({{{members}}}))")
    else:
        lines.append(f"{pad}    {call}_given({{")
        lines += textwrap.wrap(members, 96 - indent - 8,
                               initial_indent=pad + " " * 8, subsequent_indent=pad + " " * 8)
        lines[-1] += "}))"
    return lines


def generate(document):
    groups = {}
    for method in document["methods"]:
        group, _, name = method["name"].rpartition(".")
        for param in method["params"]:
            assert param["name"].isidentifier() and not keyword.iskeyword(param["name"])
        groups.setdefault(group, []).append((name, method))
    lines = [HEAD]
    for group in sorted(name for name in groups if name):
        lines += ["", f"class {group.capitalize()}(_Group):"]
        for index, (name, method) in enumerate(groups[group]):
            lines += ([""] if index else []) + function(method, name, 4)
        lines.append("")
    lines += ["", "class Methods:", '    """The methods in their groups; `call(method, params)` '
              'carries them out."""', "", "    def __init__(self, call):", "        self._call = call"]
    lines += [f"        self.{group} = {group.capitalize()}(call)"
              for group in sorted(name for name in groups if name)]
    for name, method in groups.get("", []):
        lines += ["", *function(method, name, 4)]
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    sys.stdout.write(generate(read_openrpc()))
