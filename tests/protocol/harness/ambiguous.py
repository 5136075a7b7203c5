"""Requests whose ends, targets or headers can be seen in two places, with another request hidden in each."""

HOST = "Host: 127.0.0.1\r\n"
HIDDEN = f"GET /hidden HTTP/1.1\r\n{HOST}\r\n"
LENGTH = f"Content-Length: {len(HIDDEN)}\r\n"
CHUNKED = "Transfer-Encoding: chunked\r\n"
LAST_CHUNK = "0\r\n\r\n"
LONGER = f"Content-Length: {len(LAST_CHUNK + HIDDEN)}\r\n"
SIZE = f"{len(HIDDEN):x}"
ONE_CHUNK = f"{SIZE}\r\n{HIDDEN}\r\n{LAST_CHUNK}"
ENDED = LAST_CHUNK + HIDDEN

# Headers and body.
_BODIES = (
    ("a length that covers it", LENGTH, HIDDEN),
    ("chunks that cover it", CHUNKED, ONE_CHUNK),
    ("length and chunks", LONGER + CHUNKED, ENDED),
    ("chunks and length", CHUNKED + LONGER, ENDED),
    ("a length that ends before it, and chunks that do not", "Content-Length: 4\r\n" + CHUNKED, ONE_CHUNK),
    ("two lengths", LENGTH + "Content-Length: 0\r\n", HIDDEN),
    ("two lengths, the other way", "Content-Length: 0\r\n" + LENGTH, HIDDEN),
    ("the same length twice", LENGTH + LENGTH, HIDDEN),
    ("a list of lengths", f"Content-Length: {len(HIDDEN)}, 0\r\n", HIDDEN),
    ("a list of the same length", f"Content-Length: {len(HIDDEN)}, {len(HIDDEN)}\r\n", HIDDEN),
    ("a length with a sign", f"Content-Length: +{len(HIDDEN)}\r\n", HIDDEN),
    ("a length below zero", "Content-Length: -1\r\n", HIDDEN),
    ("a length with a space in it", f"Content-Length: {len(HIDDEN)} 0\r\n", HIDDEN),
    ("a length with a fraction", f"Content-Length: {len(HIDDEN)}.0\r\n", HIDDEN),
    ("a hexadecimal length", f"Content-Length: 0x{len(HIDDEN):x}\r\n", HIDDEN),
    ("a length of 64 bits and more", f"Content-Length: {(1 << 64) + len(HIDDEN)}\r\n", HIDDEN),
    ("an empty length", "Content-Length:\r\n", HIDDEN),
    ("a length with a space before its colon", f"Content-Length : {len(HIDDEN)}\r\n", HIDDEN),
    ("an encoding with a space before its colon", LONGER + "Transfer-Encoding : chunked\r\n", ENDED),
    ("an encoding with a tab before its colon", LONGER + "Transfer-Encoding\t: chunked\r\n", ENDED),
    ("an encoding behind a tab", LONGER + "Transfer-Encoding:\tchunked\r\n", ENDED),
    ("an encoding behind a vertical tab", LONGER + "Transfer-Encoding:\x0bchunked\r\n", ENDED),
    ("an encoding with a space before its name", LONGER + " Transfer-Encoding: chunked\r\n", ENDED),
    ("a null byte in a name", LONGER + "Transfer\x00-Encoding: chunked\r\n", ENDED),
    ("a null byte in a value", LONGER + "Transfer-Encoding: chunked\x00\r\n", ENDED),
    ("an encoding in quotes", LONGER + 'Transfer-Encoding: "chunked"\r\n', ENDED),
    ("an encoding with a parameter", LONGER + "Transfer-Encoding: chunked;q=1\r\n", ENDED),
    ("another encoding", LONGER + "Transfer-Encoding: xchunked\r\n", ENDED),
    ("another encoding alone", "Transfer-Encoding: xchunked\r\n", ENDED),
    ("no encoding", LONGER + "Transfer-Encoding:\r\n", ENDED),
    ("the encoding identity", LONGER + "Transfer-Encoding: identity\r\n", ENDED),
    ("two encodings", LONGER + "Transfer-Encoding: chunked, identity\r\n", ENDED),
    ("two encodings, the other way", LONGER + "Transfer-Encoding: identity, chunked\r\n", ENDED),
    ("two encodings without length", "Transfer-Encoding: chunked, identity\r\n", ENDED),
    ("chunked twice", "Transfer-Encoding: chunked, chunked\r\n", ENDED),
    ("an empty encoding before", LONGER + "Transfer-Encoding: , chunked\r\n", ENDED),
    ("encodings in two lines", LONGER + "Transfer-Encoding: chunked\r\nTransfer-Encoding: identity\r\n", ENDED),
    ("an encoding on a second line", LONGER + "Transfer-Encoding:\r\n chunked\r\n", ENDED),
    ("a folded line", LONGER + "X: y\r\n\tTransfer-Encoding: chunked\r\n", ENDED),
    ("a header after a bare line feed", LONGER + "X: y\nTransfer-Encoding: chunked\r\n", ENDED),
    ("a header after a bare carriage return", LONGER + "X: y\rTransfer-Encoding: chunked\r\n", ENDED),
    ("a header after two carriage returns", LONGER + "X: y\r\r\nTransfer-Encoding: chunked\r\n", ENDED),
    ("an empty line of line feeds", "X: y\n\n" + HIDDEN + "Y: z\r\n", ""),
    ("an empty line of carriage returns", "X: y\r\r" + HIDDEN + "Y: z\r\n", ""),
    ("an underscore for a hyphen", LONGER + "Transfer_Encoding: chunked\r\n", ENDED),
    ("a line without a colon", LENGTH + "Transfer-Encoding\r\n", HIDDEN),
    ("a line without a name", LENGTH + ": chunked\r\n", HIDDEN),
    ("the length is named as of this connection", "Connection: content-length\r\n" + LENGTH, HIDDEN),
    ("the encoding is named as of this connection", "Connection: close, transfer-encoding\r\n" + CHUNKED, ONE_CHUNK),
    ("the end of the connection, and more", "Connection: close\r\n" + LENGTH, HIDDEN + HIDDEN),
    ("it waits for 100 Continue", "Expect: 100-continue\r\n" + LENGTH, HIDDEN),
    ("it waits for something else", "Expect: x 100-continue\r\n" + LENGTH, HIDDEN),
    ("an upgrade to an unknown version of WebSocket",
     "Connection: Upgrade\r\nUpgrade: websocket\r\nSec-WebSocket-Version: 777\r\n"
     "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n" + LENGTH, HIDDEN),
    ("an upgrade to HTTP/2", "Connection: Upgrade, HTTP2-Settings\r\nUpgrade: h2c\r\nHTTP2-Settings: \r\n" + LENGTH,
     HIDDEN),
    ("two hosts", "Host: other.example\r\n" + LENGTH, HIDDEN),
    ("a chunk with an extension", CHUNKED, f"{SIZE};a=b\r\n{HIDDEN}\r\n{LAST_CHUNK}"),
    ("an extension with a line feed", CHUNKED, f"{SIZE};a=\nb\r\n{HIDDEN}\r\n{LAST_CHUNK}"),
    ("an extension with a carriage return", CHUNKED, f"{SIZE};a=\rb\r\n{HIDDEN}\r\n{LAST_CHUNK}"),
    ("an extension with a line feed in quotes", CHUNKED, f'{SIZE};a="\n"\r\n{HIDDEN}\r\n{LAST_CHUNK}'),
    ("an extension that ends with a line feed", CHUNKED, f"2;\nxx\r\n{SIZE}\r\n0\r\n\r\n{HIDDEN}"),
    ("chunks that end with line feeds", CHUNKED, f"{SIZE}\n{HIDDEN}\n0\n\n"),
    ("a chunk longer than it says", CHUNKED, f"2\r\nabcd\r\n0\r\n\r\n{HIDDEN}"),
    ("a chunk that ends with other bytes", CHUNKED, f"2\r\nabXX0\r\n\r\n{HIDDEN}"),
    ("a chunk that ends with a line feed", CHUNKED, f"2\r\nab\n0\r\n\r\n{HIDDEN}"),
    ("a chunk of hexadecimal notation", CHUNKED, f"0x{SIZE}\r\n{HIDDEN}\r\n{LAST_CHUNK}"),
    ("a chunk with a sign", CHUNKED, f"+{SIZE}\r\n{HIDDEN}\r\n{LAST_CHUNK}"),
    ("a chunk below zero", CHUNKED, f"-{SIZE}\r\n{HIDDEN}\r\n{LAST_CHUNK}"),
    ("a chunk with a space before its size", CHUNKED, f" {SIZE}\r\n{HIDDEN}\r\n{LAST_CHUNK}"),
    ("a chunk without a size", CHUNKED, f"\r\n{HIDDEN}\r\n{LAST_CHUNK}"),
    ("a chunk of 64 bits and more", CHUNKED, f"1{'0' * 16}{SIZE}\r\n{HIDDEN}\r\n{LAST_CHUNK}"),
    ("a trailer that is a header", CHUNKED, f"{SIZE}\r\n{HIDDEN}\r\n0\r\n{LENGTH}\r\n"),
    ("a trailer that is not one", CHUNKED, f"{SIZE}\r\n{HIDDEN}\r\n0\r\n{HIDDEN}"),
)

# Request line, and what follows the host.
_LINES = (
    ("a space more before the target", "{method}  {target} HTTP/1.1\r\n"),
    ("a space more before the version", "{method} {target}  HTTP/1.1\r\n"),
    ("a space behind the version", "{method} {target} HTTP/1.1 \r\n"),
    ("a tab for a space", "{method}\t{target} HTTP/1.1\r\n"),
    ("a space in the target", "{method} {target} /hidden HTTP/1.1\r\n"),
    ("a version in the target", "{method} {target} HTTP/1.1 HTTP/1.1\r\n"),
    ("a space before the method", " {method} {target} HTTP/1.1\r\n"),
    ("an empty line before it", "\r\n{method} {target} HTTP/1.1\r\n"),
    ("a line feed before it", "\n{method} {target} HTTP/1.1\r\n"),
    ("a line feed behind it", "{method} {target} HTTP/1.1\n"),
    ("no version", "{method} {target}\r\n"),
    ("version 1.0", "{method} {target} HTTP/1.0\r\n"),
    ("version 0.9", "{method} {target} HTTP/0.9\r\n"),
    ("version 1.2", "{method} {target} HTTP/1.2\r\n"),
    ("version 1.10", "{method} {target} HTTP/1.10\r\n"),
    ("version 2.0", "{method} {target} HTTP/2.0\r\n"),
    ("a version in small letters", "{method} {target} http/1.1\r\n"),
    ("another protocol", "{method} {target} HTTPS/1.1\r\n"),
    ("another target of its own host", "{method} http://other.example{target} HTTP/1.1\r\n"),
    ("a fragment", "{method} {target}#/hidden HTTP/1.1\r\n"),
    ("a null byte in the target", "{method} {target}\x00/hidden HTTP/1.1\r\n"),
    ("a carriage return in the target", "{method} {target}\r/hidden HTTP/1.1\r\n"),
    ("a method of odd characters", "{method}( {target} HTTP/1.1\r\n"),
    ("a method in small letters", "get {target} HTTP/1.1\r\n"),
    ("the method CONNECT", "CONNECT 127.0.0.1:80 HTTP/1.1\r\n"),
    ("the method TRACE", "TRACE {target} HTTP/1.1\r\n"),
    ("the method HEAD", "HEAD {target} HTTP/1.1\r\n"),
    ("the beginning of HTTP/2", "PRI * HTTP/2.0\r\n"),
)


def ambiguous_requests(method, target, number):
    """Names and bytes. Each has the header X-Case, with numbers from this one on."""
    line = f"{method} {target} HTTP/1.1\r\n"
    found = [(name, line, fields, body) for name, fields, body in _BODIES]
    found += [(f"{name}, with a length", other.format(method=method, target=target), LENGTH, HIDDEN)
              for name, other in _LINES]
    found += [(f"{name}, with chunks", other.format(method=method, target=target), CHUNKED, ONE_CHUNK)
              for name, other in _LINES if "version" in name or "method" in name]
    return [(f"{name} ({method})", f"{first}{HOST}X-Case: {i}\r\n{fields}\r\n{body}".encode("latin-1"))
            for i, (name, first, fields, body) in enumerate(found, number)]
