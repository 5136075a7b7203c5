// The codecs that this browser decodes.

import { videoConfig } from "./video_frames.ts";

/** Codec names for `hello`. A server ignores those that it does not have. */
export async function decodableCodecs(): Promise<string[]> {
  return (await decodesVideo()) ? ["h264", "jpeg"] : ["jpeg"];
}

async function decodesVideo(): Promise<boolean> {
  if (typeof VideoDecoder !== "function") return false;
  try {
    return (await VideoDecoder.isConfigSupported(videoConfig)).supported === true;
  } catch {
    return false;
  }
}
