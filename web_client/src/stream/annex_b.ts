// Reads from an H.264 byte stream (ITU-T H.264, annex B and 7.3.2.1) what a decoder's configuration
// needs.

const sequenceParameterSet = 7;

/** "avc1.PPCCLL" out of the first sequence parameter set; null without one. */
export function codecString(stream: Uint8Array): string | null {
  for (let at = 0; at + 6 < stream.length; at += 1) {
    const startsUnit = stream[at] === 0 && stream[at + 1] === 0 && stream[at + 2] === 1;
    if (!startsUnit || (stream[at + 3]! & 31) !== sequenceParameterSet) continue;
    const profile = [stream[at + 4]!, stream[at + 5]!, stream[at + 6]!];
    return `avc1.${profile.map((byte) => byte.toString(16).padStart(2, "0")).join("")}`;
  }
  return null;
}
