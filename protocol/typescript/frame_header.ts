// The binary frame message: a fixed little-endian header, followed by the encoded frame.

const magic = 0x46525648; // 'H' 'V' 'R' 'F' read as a little-endian word
const minimumHeaderBytes = 64;
const supportedVersion = 1;

export const Codec = { jpeg: 1, png: 2, webp: 3, h264: 16 } as const;
export const FrameFlag = { key: 1, final: 2, afterDrop: 4, discontinuity: 8, depth: 16 } as const;

export interface FrameHeader {
  type: number;
  codec: number;
  flags: number;
  headerBytes: number;
  quality: number;
  /** Number of the frame for this viewer; the server has skipped frames that are missing. */
  frameSeq: number;
  renderId: number;
  /** Sequence number of the newest camera in this frame. */
  inputSeqEcho: number;
  stateRev: number;
  width: number;
  height: number;
  x: number;
  y: number;
  fullWidth: number;
  fullHeight: number;
  /** Server clock, microseconds. */
  renderStartUs: number;
  renderUs: number;
  encodeUs: number;
  queueUs: number;
  /** Accumulated samples per pixel; 0 for a purely rasterised frame. */
  sampleCount: number;
}

export class FrameFormatError extends Error {}

/** Reads the header of one binary message. @throws FrameFormatError */
export function parseFrameHeader(message: ArrayBuffer): FrameHeader {
  if (message.byteLength < minimumHeaderBytes) {
    throw new FrameFormatError(`frame message of ${message.byteLength} bytes has no full header`);
  }
  const view = new DataView(message);
  if (view.getUint32(0, true) !== magic) {
    throw new FrameFormatError("frame message does not start with the frame magic");
  }
  const version = view.getUint8(4);
  if (version !== supportedVersion) {
    throw new FrameFormatError(`frame header version ${version} is not ${supportedVersion}`);
  }
  const headerBytes = view.getUint16(8, true);
  if (headerBytes < minimumHeaderBytes || headerBytes > message.byteLength) {
    throw new FrameFormatError(`frame header claims ${headerBytes} bytes`);
  }
  return {
    type: view.getUint8(5),
    codec: view.getUint8(6),
    flags: view.getUint8(7),
    headerBytes,
    quality: view.getUint16(10, true),
    frameSeq: view.getUint32(12, true),
    renderId: view.getUint32(16, true),
    inputSeqEcho: view.getUint32(20, true),
    stateRev: view.getUint32(24, true),
    width: view.getUint16(28, true),
    height: view.getUint16(30, true),
    x: view.getUint16(32, true),
    y: view.getUint16(34, true),
    fullWidth: view.getUint16(36, true),
    fullHeight: view.getUint16(38, true),
    renderStartUs: Number(view.getBigUint64(40, true)),
    renderUs: view.getUint32(48, true),
    encodeUs: view.getUint32(52, true),
    queueUs: view.getUint32(56, true),
    sampleCount: view.getUint32(60, true),
  };
}

/** The MIME type of an image codec; null for all others. */
export function mimeType(codec: number): string | null {
  switch (codec) {
    case Codec.jpeg:
      return "image/jpeg";
    case Codec.png:
      return "image/png";
    case Codec.webp:
      return "image/webp";
    default:
      return null;
  }
}
