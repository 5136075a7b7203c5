// Which codecs this browser decodes.

import { videoConfig } from "./video_frames.ts";

/** Names as hello knows them. A server that has none but JPEG ignores the others. */
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
