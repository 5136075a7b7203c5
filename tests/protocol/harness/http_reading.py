"""Reads HTTP/1.1 as RFC 9112 says and no other way: what could be read differently is refused. It shares nothing
with the server, so that the two can be compared."""

import re
from dataclasses import dataclass

HEAD_END = b"\r\n\r\n"
# They may not stand in trailers, RFC 9110 section 6.5.1.
_ONLY_IN_HEADS = ("content-length", "host", "transfer-encoding")
_REQUEST_LINE = re.compile(rb"([!#$%&'*+.^_`|~0-9A-Za-z-]+) ([\x21-\x7e\x80-\xff]+) HTTP/1\.([01])")
_FIELD = re.compile(rb"([!#$%&'*+.^_`|~0-9A-Za-z-]+):[ \t]*([\t\x20-\x7e\x80-\xff]*?)[ \t]*")
_CHUNK = re.compile(rb"([0-9A-Fa-f]{1,16})(?:[ \t]*;[\t\x20-\x7e\x80-\xff]*)?")


class Ambiguous(Exception):
    """Two programs could read it differently."""


class Incomplete(Exception):
    """Its end has not come."""


@dataclass
class Request:
    method: str = ""
    target: str = ""
    fields: dict = None
    last: bool = False  # of its connection
    refused: str = ""  # why; nothing can be read behind it


def _fields(lines):
    fields = {}
    for line in lines:
        found = _FIELD.fullmatch(line)
        if not found:
            raise Ambiguous(f"field {line!r}")
        fields.setdefault(found[1].decode().lower(), []).append(found[2].decode("latin-1"))
    return fields


def _line(data, at):
    end = data.find(b"\r\n", at)
    if end < 0:
        raise Incomplete
    return data[at:end], end + 2


def _after_chunks(data, at):
    while True:
        line, at = _line(data, at)
        found = _CHUNK.fullmatch(line)
        if not found:
            raise Ambiguous(f"chunk {line!r}")
        size = int(found[1], 16)
        if size == 0:
            break
        if len(data) < at + size + 2:
            raise Incomplete
        if data[at + size:at + size + 2] != b"\r\n":
            raise Ambiguous("the end of a chunk")
        at += size + 2
    trailers = []
    while True:
        line, at = _line(data, at)
        if not line:
            if any(name in _fields(trailers) for name in _ONLY_IN_HEADS):
                raise Ambiguous("a trailer")
            return at
        trailers.append(line)


def _after_body(data, at, fields, minor):
    lengths, encodings = fields.get("content-length", []), fields.get("transfer-encoding", [])
    if encodings:
        if lengths or minor == 0 or [one.lower() for one in encodings] != ["chunked"]:
            raise Ambiguous("the encoding")
        return _after_chunks(data, at)
    if not lengths:
        return at
    if len(lengths) > 1 or not re.fullmatch("[0-9]{1,18}", lengths[0]):
        raise Ambiguous("the length")
    if len(data) < at + int(lengths[0]):
        raise Incomplete
    return at + int(lengths[0])


def _is_upgrade(method, fields, connection):
    """To WebSocket: what follows is no HTTP, or, where it is refused, nothing."""
    return (method == b"GET" and "upgrade" in connection and
            "websocket" in [one.lower() for one in fields.get("upgrade", [])])


def _read_request(data, at):
    end = data.find(HEAD_END, at)
    if end < 0:
        raise Incomplete
    first, *rest = data[at:end].split(b"\r\n")
    line = _REQUEST_LINE.fullmatch(first)
    if not line:
        raise Ambiguous(f"line {first!r}")
    fields, minor = _fields(rest), int(line[3])
    if len(fields.get("host", [])) not in ((1,) if minor else (0, 1)):
        raise Ambiguous("the host")
    connection = re.split(r"[ \t]*,[ \t]*", ",".join(fields.get("connection", [])).lower())
    request = Request(line[1].decode(), line[2].decode("latin-1"), fields,
                      "close" in connection or _is_upgrade(line[1], fields, connection) or
                      (minor == 0 and "keep-alive" not in connection))
    return request, _after_body(data, end + len(HEAD_END), fields, minor)


def requests_of(data):
    """Those that are whole, up to one that ends the connection or has to be refused."""
    data, at, found = bytes(data), 0, []
    while at < len(data):
        try:
            request, at = _read_request(data, at)
        except Incomplete:
            return found
        except Ambiguous as reason:
            return [*found, Request(refused=str(reason))]
        found.append(request)
        if request.last:
            break
    return found


@dataclass
class Response:
    status: int
    body: bytes


def _responses(data, methods):
    """Those that are whole, and where what follows them begins."""
    data, at, found = bytes(data), 0, []
    while (end := data.find(HEAD_END, at)) >= 0:
        first, *rest = data[at:end].split(b"\r\n")
        status, fields, body = int(first.split()[1]), _fields(rest), end + len(HEAD_END)
        if status < 200 and status != 101:
            at = body
            continue
        method = methods[len(found)] if len(found) < len(methods) else "GET"
        bodiless = method == "HEAD" or status in (101, 204, 304)
        size = 0 if bodiless else int(fields["content-length"][0])
        if len(data) < body + size:
            break
        found.append(Response(status, data[body:body + size]))
        at = body + size
        if status == 101:
            return found, len(data)
    return found, at


def responses_of(data, methods):
    """Final responses to requests of these methods that are whole, in turn; those to further ones as to GET."""
    return _responses(data, methods)[0]


def disagreement(sent, answered):
    """Why these bytes of a connection are not one response for each request, or nothing."""
    requests = requests_of(sent)
    responses, end = _responses(answered, [request.method for request in requests])
    if end < len(answered):
        return f"no whole response: {bytes(answered[end:])[-400:]!r}"
    if len(responses) != len(requests):
        return f"{len(requests)} requests, {len(responses)} responses to {bytes(sent)!r}: {bytes(answered)[-400:]!r}"
    if requests and requests[-1].refused and responses[-1].status < 400:
        return f"{requests[-1].refused} was answered with {responses[-1].status}"
    return ""
