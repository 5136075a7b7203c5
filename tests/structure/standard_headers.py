#!/usr/bin/env python3
"""Checks that a file includes the standard headers of what it names, itself or by the project's own
headers: what a standard header brings along with it differs from one compiler's library to the next."""

import functools
import pathlib
import re
import sys

from sources import ROOT, check

# Header -> names of namespace std that only it is sure to declare.
NAMES = {
    "algorithm": r"sort|stable_sort|find_if|any_of|all_of|none_of|clamp|count_if|transform|"
                 r"min_element|max_element|lower_bound|upper_bound|fill|nth_element",
    "array": r"array",
    "atomic": r"atomic\w*",
    "bit": r"bit_cast|bit_width|bit_ceil|popcount|endian",
    "chrono": r"chrono",
    "cmath": r"sqrt|pow|sin|cos|tan|acos|asin|atan2|exp2?|log2?|log10|floor|ceil|lround|isfinite|"
             r"isnan|isinf|cbrt|hypot|fma",
    "condition_variable": r"condition_variable\w*",
    "cstdint": r"u?int(8|16|32|64)_t|uintptr_t",
    "cstring": r"memcpy|memcmp|memset|memmove|strlen|strcmp|strerror",
    "deque": r"deque",
    "filesystem": r"filesystem",
    "fstream": r"[io]?fstream",
    "functional": r"function|hash|greater",
    "limits": r"numeric_limits",
    "map": r"map|multimap",
    "memory": r"unique_ptr|shared_ptr|weak_ptr|make_unique|make_shared|enable_shared_from_this",
    "mutex": r"mutex|lock_guard|unique_lock|scoped_lock|call_once|once_flag",
    "numbers": r"numbers",
    "numeric": r"accumulate|iota|reduce|lcm|gcd",
    "optional": r"optional|nullopt",
    "random": r"mt19937\w*|uniform_\w+_distribution",
    "set": r"set|multiset",
    "span": r"span",
    "sstream": r"[io]?stringstream",
    "stdexcept": r"runtime_error|invalid_argument|logic_error|out_of_range",
    "string": r"string|to_string",
    "string_view": r"string_view",
    "thread": r"thread|jthread|this_thread",
    "tuple": r"tuple|make_tuple|tie",
    "unordered_map": r"unordered_map",
    "unordered_set": r"unordered_set",
    "variant": r"variant|visit|holds_alternative|monostate",
    "vector": r"vector",
}
USES = {header: re.compile(rf"\bstd::({names})\b(?!_)") for header, names in NAMES.items()}
# A standard header that is sure to declare another's names.
BRINGS = {"string": {"string_view"}, "map": {"tuple"}}
INCLUDE = re.compile(r'^\s*#\s*include\s+(?:<([^>]+)>|"([^"]+)")', re.MULTILINE)
COMMENT_OR_TEXT = re.compile(r'//[^\n]*|/\*.*?\*/|R"\(.*?\)"|"(?:\\.|[^"\\\n])*"', re.DOTALL)


@functools.cache
def text_of(path: pathlib.Path) -> str:
    return path.read_text()


@functools.cache
def included(path: pathlib.Path) -> frozenset:
    """Standard headers that the file includes, by the project's own headers as well."""
    found, waiting, seen = set(), [path], set()
    while waiting:
        current = waiting.pop()
        if current in seen:
            continue
        seen.add(current)
        for standard, own in INCLUDE.findall(text_of(current)):
            if standard:
                found |= {standard} | BRINGS.get(standard, set())
                continue
            for folder in (current.parent, ROOT, ROOT / "server", ROOT / "tests"):
                if (folder / own).is_file():
                    waiting.append((folder / own).resolve())
                    break
    return frozenset(found)


def missing(path: pathlib.Path):
    code = COMMENT_OR_TEXT.sub("", text_of(path))
    for header, uses in USES.items():
        match = uses.search(code)
        if match and header not in included(path):
            yield f"{path.relative_to(ROOT)}: {match.group(0)} without <{header}>"


sys.exit(check(("protocol", "server", "tests", "web_client", "shaders"), 200, missing,
               "all standard headers are included"))
