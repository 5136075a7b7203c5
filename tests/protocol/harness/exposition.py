"""Parses the Prometheus text format 0.0.4, strictly: whatever it leaves open is an error."""

import math
import re

_NAME = r"[a-zA-Z_:][a-zA-Z0-9_:]*"
_LABEL = r'[a-zA-Z_][a-zA-Z0-9_]*="(?:[^"\\\n]|\\\\|\\"|\\n)*"'
_SAMPLE = re.compile(rf"({_NAME})(?:\{{({_LABEL}(?:,{_LABEL})*)\}})? (\S+)")
_HELP = re.compile(rf"# HELP ({_NAME}) (.+)")
_TYPE = re.compile(rf"# TYPE ({_NAME}) (counter|gauge|histogram|summary|untyped)")
_PAIR = re.compile(r'([a-zA-Z_][a-zA-Z0-9_]*)="((?:[^"\\\n]|\\.)*)"')


class Family:
    def __init__(self, name, text):
        self.name, self.help, self.type, self.samples = name, text, None, {}


def parse(page):
    """Families by name. Each is described once, before its samples, and in one piece."""
    assert page.endswith("\n"), "the last line must end"
    families, current = {}, None
    for number, line in enumerate(page[:-1].split("\n"), 1):
        where = f"line {number}: {line!r}"
        if described := _HELP.fullmatch(line):
            name, text = described.groups()
            assert name not in families, "described twice, " + where
            current = families[name] = Family(name, text)
        elif typed := _TYPE.fullmatch(line):
            assert current and typed[1] == current.name and current.type is None, where
            current.type = typed[2]
        else:
            sample = _SAMPLE.fullmatch(line)
            assert sample, where
            _add(current, *sample.groups(), where)
    for family in families.values():
        assert family.type, f"{family.name} has no type"
        if family.type == "histogram":
            _check_histogram(family)
    return families


def _add(family, name, labels, value, where):
    assert family and family.type, "a sample before its description, " + where
    suffix = name[len(family.name):]
    allowed = ("_bucket", "_sum", "_count") if family.type == "histogram" else ("",)
    assert name.startswith(family.name) and suffix in allowed, where
    pairs = _PAIR.findall(labels or "")
    assert len({label for label, _ in pairs}) == len(pairs), "a label twice, " + where
    number = float(value.replace("Inf", "inf"))
    if family.type in ("counter", "histogram"):
        assert number >= 0 and math.isfinite(number), where
    if family.type == "counter":
        assert family.name.endswith("_total"), where
    key = (suffix, tuple(sorted(pairs)))
    assert key not in family.samples, "a sample twice, " + where
    family.samples[key] = number


def _check_histogram(family):
    groups = {}
    for (suffix, pairs), value in family.samples.items():
        rest = tuple(pair for pair in pairs if pair[0] != "le")
        group = groups.setdefault(rest, {"buckets": []})
        if suffix == "_bucket":
            group["buckets"].append((float(dict(pairs)["le"].replace("Inf", "inf")), value))
        else:
            group[suffix] = value
    for rest, group in groups.items():
        bounds = [bound for bound, _ in group["buckets"]]
        counts = [count for _, count in group["buckets"]]
        assert bounds == sorted(set(bounds)) and bounds[-1] == math.inf, (family.name, rest)
        assert counts == sorted(counts), f"{family.name} {rest} does not add up"
        assert counts[-1] == group["_count"], (family.name, rest)
        assert "_sum" in group, (family.name, rest)
