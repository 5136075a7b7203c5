// Takes multipart/x-mixed-replace apart. An <img> could show it by itself, but would not tell when
// it has ended.

const lineEnd = 13;

export class MultipartReader {
  private readonly mark: Uint8Array;
  /** From the beginning of the mark before the newest part. */
  private pending: Uint8Array;
  private searched = 1;

  constructor(boundary: string) {
    this.mark = bytesOf(`\r\n--${boundary}`);
    this.pending = bytesOf("\r\n"); // the first mark is at the beginning, without a line before it
  }

  /** The newest part that these bytes complete; null where none is complete. */
  push(bytes: Uint8Array): Uint8Array | null {
    this.pending = joined(this.pending, bytes);
    let newest: Uint8Array | null = null;
    for (let end = this.nextMark(); end >= 0; end = this.nextMark()) {
      newest = bodyOf(this.pending.subarray(0, end));
      this.pending = this.pending.subarray(end);
      this.searched = 1;
    }
    return newest;
  }

  private nextMark(): number {
    const found = find(this.pending, this.mark, this.searched);
    if (found < 0) this.searched = Math.max(1, this.pending.length - this.mark.length + 1);
    return found;
  }
}

/** What follows the empty line after a part's headers. */
function bodyOf(part: Uint8Array): Uint8Array | null {
  const empty = bytesOf("\r\n\r\n");
  const headersEnd = find(part, empty, 0);
  return headersEnd < 0 ? null : part.slice(headersEnd + empty.length);
}

/** All the marks begin with a line's end. */
function find(bytes: Uint8Array, mark: Uint8Array, from: number): number {
  let at = bytes.indexOf(lineEnd, from);
  while (at >= 0 && !mark.every((value, index) => bytes[at + index] === value)) {
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
