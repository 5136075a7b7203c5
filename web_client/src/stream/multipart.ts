// Parses multipart/x-mixed-replace. An <img> could show it directly, but does not report its end.

const lineEnd = 13;

export class MultipartReader {
  private readonly delimiter: Uint8Array;
  /** Starts with the boundary before the newest part. */
  private pending: Uint8Array;
  private searched = 1;

  constructor(boundary: string) {
    this.delimiter = bytesOf(`\r\n--${boundary}`);
    this.pending = bytesOf("\r\n"); // the first boundary has no line before it
  }

  /** The newest part that these bytes complete; null without one. */
  push(bytes: Uint8Array): Uint8Array | null {
    this.pending = joined(this.pending, bytes);
    let newest: Uint8Array | null = null;
    for (let end = this.nextBoundary(); end >= 0; end = this.nextBoundary()) {
      newest = bodyOf(this.pending.subarray(0, end));
      this.pending = this.pending.subarray(end);
      this.searched = 1;
    }
    return newest;
  }

  private nextBoundary(): number {
    const found = find(this.pending, this.delimiter, this.searched);
    if (found < 0) this.searched = Math.max(1, this.pending.length - this.delimiter.length + 1);
    return found;
  }
}

/** The content after a part's headers and the empty line. */
function bodyOf(part: Uint8Array): Uint8Array | null {
  const empty = bytesOf("\r\n\r\n");
  const headersEnd = find(part, empty, 0);
  return headersEnd < 0 ? null : part.slice(headersEnd + empty.length);
}

/** Finds a byte sequence that begins with CR. */
function find(bytes: Uint8Array, sequence: Uint8Array, from: number): number {
  let at = bytes.indexOf(lineEnd, from);
  while (at >= 0 && !sequence.every((value, index) => bytes[at + index] === value)) {
    at = bytes.indexOf(lineEnd, at + 1);
  }
  return at;
}

function joined(first: Uint8Array, second: Uint8Array): Uint8Array {
  const both = new Uint8Array(first.length + second.length);
  both.set(first);
  both.set(second, first.length);
  return both;
}

function bytesOf(text: string): Uint8Array {
  return new TextEncoder().encode(text);
}
