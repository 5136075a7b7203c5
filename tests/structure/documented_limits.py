#!/usr/bin/env python3
"""Checks that the limits in the documents are those of the code. Every row of the tables below is
put together from constants of the sources and must stand in its document; a row of the document that
is not listed here is an error too."""

import functools
import pathlib
import re
import sys

from sources import ROOT

UNITS = {"milliseconds": "ms", "seconds": "s", "minutes": "min"}
COMMENT = re.compile(r"//[^\n]*|/\*.*?\*/", re.DOTALL)


class Unknown(Exception):
    """A constant that is not in the sources, or more than once."""


@functools.cache
def sources(folder: str):
    """The texts of all sources below the folder, without comments."""
    return [COMMENT.sub("", path.read_text()) for pattern in ("*.hpp", "*.cpp")
            for path in sorted((ROOT / folder).rglob(pattern))]


def body_of(text: str, name: str):
    """What stands between the braces of a struct or class, or None."""
    start = re.search(rf"\b(?:struct|class)\s+{name}\b[^;{{()]*\{{", text)
    if not start:
        return None
    depth = 1
    for end in range(start.end(), len(text)):
        depth += {"{": 1, "}": -1}.get(text[end], 0)
        if depth == 0:
            return text[start.end():end]
    return None


def evaluate(expression: str):
    """The value of an integer or floating point expression of C++ literals."""
    plain = re.sub(r"(?<=[0-9a-fA-F.])(?:ull|ul|u|f)\b", "", expression.replace("'", ""))
    if not re.fullmatch(r"[0-9.e()<*+ -]+", plain):
        raise Unknown(f"the value {expression} is not made of numbers")
    return eval(plain)  # digits and operators only, see above


def constant(folder: str, name: str):
    """Value and unit of a constant or a member's default below `folder`: "a_constant" or
    "Struct::member". The unit is that of a std::chrono type, or None."""
    *owner, member = name.split("::")
    declared = re.compile(rf"\b(?:std::chrono::)?(\w+)\s+{member}\s*(?:=\s*|\{{)([^;{{}}]+?)\}}?;")
    found = set()
    for text in sources(folder):
        if member not in text:
            continue
        if owner:
            text = body_of(text, owner[0]) or ""
        else:
            text = "\n".join(re.findall(r"\bconstexpr\b[^;]*;", text))
        found |= set(declared.findall(text))
    if len(found) != 1:
        raise Unknown(f"{folder} has {len(found)} constants called {name}")
    (kind, expression), = found
    return evaluate(expression), UNITS.get(kind)


def plain(folder, name):
    value = constant(folder, name)[0]
    return str(int(value)) if value == int(value) else str(value)


def duration(folder, name, unit=None):
    value, own = constant(folder, name)
    if not (unit or own):
        raise Unknown(f"{name} is no duration")
    return f"{value:g} {unit or own}"


def size(folder, name):
    value = constant(folder, name)[0]
    for unit, shift in (("GiB", 30), ("MiB", 20), ("KiB", 10)):
        if value >= 1 << shift and value % (1 << shift) == 0:
            return f"{int(value) >> shift} {unit}"
    return f"{int(value)} bytes"


def count(folder, name):
    """200000 -> "200,000", 20000000 -> "20 million"."""
    value = int(constant(folder, name)[0])
    if value >= 1_000_000:
        return f"{value / 1e6:.0f} million"
    return f"{value:,}" if value >= 100_000 else str(value)


NET, SESSION, STREAM, PROTOCOL = "server/net", "server/session", "server/stream", "protocol"
CLI, SCENE = "server/cli", "server/scene"


def rate(per_second, at_once):
    return f"{plain(NET, per_second)} per second, bursts of {plain(NET, at_once)}"


def operation():
    """Rows of server/README.md: what, limit."""
    captures = plain(SESSION, "SessionLimits::max_captures")
    messages = "messages queued for a viewer"
    stalled = duration(NET, "stall_timeout")
    forgiven = 1 / constant(NET, "forgiven_per_second")[0]
    yield "request head", size(NET, "max_request_head_bytes")
    yield "first request, TLS handshake, WebSocket upgrade", duration(NET, "handshake_timeout")
    yield "message or request body", size(PROTOCOL, "DispatchLimits::max_message_bytes")
    yield "nesting of JSON", plain(PROTOCOL, "DispatchLimits::max_depth") + " levels"
    yield "calls in a batch", plain(PROTOCOL, "DispatchLimits::max_batch")
    yield "messages per connection", rate("calls_per_second", "calls_at_once")
    yield "messages over that limit", rate("rejections_per_second", "rejections_at_once")
    yield "pings per connection", rate("pings_per_second", "pings_at_once")
    yield "unanswered captures per session", captures
    yield "unanswered probes (`scene.pick`, `frame.inspect`) per session", captures
    yield "unanswered steps per session", captures
    yield f"{messages} that reads nothing for {stalled}", plain(NET, "unchecked_pending_messages")
    yield messages, plain(NET, "max_pending_messages")
    yield "bytes of answers queued for a viewer", size(NET, "max_pending_bytes")
    yield "bytes of answers queued for all connections", size(NET, "max_outgoing_bytes")
    yield "frame without acknowledgement", duration(NET, "ack_timeout")
    yield "HTTP answer without progress", duration(NET, "idle_timeout")
    yield "MJPEG frame without progress", duration(NET, "write_timeout")
    yield "rate of a long answer, on average", size(NET, "min_bytes_per_second") + "/s"
    yield "silence on a connection, pings unanswered", duration(NET, "idle_timeout")
    yield "duration of an upload", duration(NET, "max_upload_duration")
    yield "wrong tokens from an address", \
        f"{plain(NET, 'most_failures')}, then 1 per {forgiven:g} s"
    yield "length of a token", \
        f"{plain(NET, 'shortest_token')} to {plain(NET, 'longest_token')} characters"
    yield "connections", option("max_connections")
    yield "connections per address", option("max_connections_per_client")
    yield "connections to `--metrics-listen`", plain(NET, "max_metrics_connections")
    yield "viewers per session", option("max_viewers")
    yield "viewers of all sessions", option("max_all_viewers")
    yield "sessions", option("max_sessions")
    yield "pixels of all sessions", option("max_pixels")
    yield "session without viewers and calls", option("session_idle_timeout") + " s"
    yield "session without viewers", option("release_after") + " s"


def option(member):
    return f"`--{member.replace('_', '-')}` {plain(CLI, 'ServeOptions::' + member)}"


def messages():
    """Rows of protocol/README.md: what, limit."""
    window, longest = plain(STREAM, "ack_window"), plain(STREAM, "max_ack_window")
    yield "length of a message", size(PROTOCOL, "DispatchLimits::max_message_bytes")
    yield "nesting of JSON", plain(PROTOCOL, "DispatchLimits::max_depth") + " levels"
    yield "calls in a batch", plain(PROTOCOL, "DispatchLimits::max_batch")
    yield "unanswered captures, probes and steps per session (`limits.max_pending` in `hello`)", \
        plain(SESSION, "SessionLimits::max_captures") + " each"
    yield "frames without acknowledgement", f"{window}, up to {longest} on links with high latency"
    yield "time without acknowledgement", duration(NET, "ack_timeout")
    yield "delay of the final frame after the last change", duration(SESSION, "final_delay", "ms")
    yield "quality of the final JPEG", plain(STREAM, "still_quality") + " or more"
    yield "interval of repeated frames of `stream.mjpg`", duration(NET, "repeat_interval")
    yield "interval between key frames for new viewers", \
        duration(STREAM, "VariantPlanner::min_key_interval")


def scene_files():
    """Rows of server/scene/README.md: option, default."""
    def limit(form, member):
        return form(SCENE, "ImportLimits::" + member)

    yield "`--max-scene-bytes`", limit(size, "file_bytes")
    yield "`--max-unpacked-bytes`", limit(size, "unpacked_bytes")
    yield "`--max-geometry-bytes`", limit(size, "scene_bytes")
    yield "`--max-triangles`", limit(count, "triangles")
    yield "`--max-texels`", limit(count, "texels")
    yield "`--max-texture-size`", limit(plain, "texture_size")
    yield "`--max-nodes`", limit(count, "nodes")
    yield "`--max-instances`", limit(count, "instances")
    yield "`--max-node-depth`", limit(plain, "node_depth")
    yield "nesting of JSON", limit(plain, "json_depth") + " levels"
    yield "values of JSON", limit(count, "json_values")


def error_codes():
    """Rows of protocol/README.md: codes alone."""
    text = body_of((ROOT / "protocol/result.hpp").read_text().replace("enum class", "struct")
                   .replace("ErrorCode : int", "ErrorCode"), "ErrorCode") or ""
    return re.findall(r"=\s*(-\d+)", text)


TABLES = (
    ("server/README.md", "Limits", operation),
    ("protocol/README.md", "Limits of messages", messages),
    ("server/scene/README.md", "Import limits", scene_files),
    ("protocol/README.md", "Errors", error_codes),
)


def section(document: str, heading: str) -> str:
    text = (ROOT / document).read_text()
    found = re.search(rf"(?ms)^#+ {re.escape(heading)}$(.*?)(?=^#+ |\Z)", text)
    if not found:
        raise Unknown(f"{document} has no heading \"{heading}\"")
    return found.group(1)


def table_rows(text: str):
    """The cells of the first table, without its head."""
    lines = [line for line in text.splitlines() if line.startswith("|")]
    first = text[text.index("|"):] if lines else ""
    table = re.match(r"(?:\|[^\n]*\n)+", first).group().splitlines() if lines else []
    return [[cell.strip() for cell in line.strip("|").split("|")] for line in table[2:]]


def faults():
    for document, heading, expected in TABLES:
        try:
            rows = list(expected())
            found = table_rows(section(document, heading))
        except Unknown as unknown:
            yield f"{document}, {heading}: {unknown} (see {pathlib.Path(__file__).name})"
            continue
        in_code = [[row] if isinstance(row, str) else list(row) for row in rows]
        in_document = [cells[:len(in_code[0])] for cells in found] if in_code else []
        if len(in_code) < 5:
            yield f"{document}, {heading}: only {len(in_code)} limits found in the code"
        for row in in_code:
            if row not in in_document:
                yield f"{document}, {heading}: missing row, from the code: | {' | '.join(row)} |"
        for row in in_document:
            if row not in in_code:
                yield f"{document}, {heading}: the code has no such limit: | {' | '.join(row)} |"


def main() -> int:
    found = list(faults())
    print("\n".join(found) if found else f"{len(TABLES)} tables: every limit is the code's")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
