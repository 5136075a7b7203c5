"""Reads the output of `heliograph schema` for the generators of the client libraries."""

import json
import sys


def read_openrpc(stream=sys.stdin):
    """The OpenRPC document out of what `heliograph schema` prints."""
    return json.load(stream)["openrpc"]


def sentence(text):
    """The text on one line."""
    return " ".join(text.split())


def with_unit(text, schema):
    """The text of a value, followed by its unit in brackets if it has one."""
    unit = schema.get("x-unit")
    return sentence(text) + (f" [{unit}]" if unit else "")


def kinds_of(schema):
    """The JSON Schema types of a value without null, and whether it may be null."""
    kind = schema.get("type", "object")
    kinds = kind if isinstance(kind, list) else [kind]
    return [one for one in kinds if one != "null"], "null" in kinds
