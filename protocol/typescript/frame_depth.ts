// The camera of a frame and where its surfaces are, coarsely: they follow the header of frames that
// were asked for with `depth` in stream.configure.

import { type FrameHeader, FrameFlag, FrameFormatError } from "./frame_header.ts";
import type { Vector3 } from "./json.ts";

const headerBytes = 64;
const fixedBytes = 52;

export interface FrameDepth {
  /** Samples in a row and in a column; they cover the frame. */
  width: number;
  height: number;
  /** Distance of the nearest sample along the view, metres. */
  nearest: number;
  eye: Vector3;
  target: Vector3;
  up: Vector3;
  /** Degrees. */
  verticalFov: number;
  /** Row 0 on top: 65535 * nearest / distance along the view; 0: the background. */
  samples: Uint16Array<ArrayBuffer>;
}

/** The depth of a frame, or null where it has none. @throws FrameFormatError, TypeError */
export async function readFrameDepth(
  message: ArrayBuffer,
  header: FrameHeader,
): Promise<FrameDepth | null> {
  if ((header.flags & FrameFlag.depth) === 0) return null;
  if (header.headerBytes < headerBytes + fixedBytes) {
    throw new FrameFormatError(`frame header of ${header.headerBytes} bytes has no depth`);
  }
  const view = new DataView(message, headerBytes);
  const float = (offset: number): number => view.getFloat32(offset, true);
  const vector = (offset: number): Vector3 => [float(offset), float(offset + 4), float(offset + 8)];
  const [width, height] = [view.getUint16(0, true), view.getUint16(2, true)];
  const compressed = view.getUint32(48, true);
  if (headerBytes + fixedBytes + compressed > header.headerBytes) {
    throw new FrameFormatError(`depth of ${compressed} bytes exceeds the frame header`);
  }
  const bytes = await inflate(new Uint8Array(message, headerBytes + fixedBytes, compressed));
  if (bytes.length !== 2 * width * height) {
    throw new FrameFormatError(`depth plane has ${bytes.length} bytes`);
  }
  return {
    width,
    height,
    nearest: float(4),
    eye: vector(8),
    target: vector(20),
    up: vector(32),
    verticalFov: float(44),
    samples: samplesOf(bytes, width),
  };
}

async function inflate(bytes: Uint8Array<ArrayBuffer>): Promise<Uint8Array> {
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

/** Adds the differences from what a plane through the neighbours predicts. */
function samplesOf(bytes: Uint8Array, width: number): Uint16Array<ArrayBuffer> {
  const count = bytes.length / 2;
  const samples = new Uint16Array(count);
  for (let i = 0; i < count; i += 1) {
    const folded = bytes[i]! | (bytes[count + i]! << 8);
    const difference = (folded >> 1) ^ -(folded & 1);
    const left = i % width > 0 ? samples[i - 1]! : 0;
    const above = i >= width ? samples[i - width]! : 0;
    const corner = i % width > 0 && i >= width ? samples[i - width - 1]! : 0;
    samples[i] = left + above - corner + difference;
  }
  return samples;
}
