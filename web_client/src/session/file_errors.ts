// Why a scene or an environment cannot be shown, in the words of someone who has the file, not of its format.

import { ErrorCode } from "heliograph/messages.ts";
import { RpcError } from "heliograph/rpc.ts";

export interface FileError {
  sentence: string;
  /** What the server says, for those who make files; empty where it adds nothing. */
  detail: string;
}

const meanings: [pattern: RegExp, meaning: string][] = [
  [
    /truncated|ends early|past the end|claims more|header states|too short|cannot be read compl/,
    "is incomplete: the file ends early",
  ],
  [/the file is empty/, "is empty"],
  [/is a cube map/, "is a cube map; environments are panoramas of 360 x 180 degrees"],
  [/not a Radiance|format other than/, "is not an environment in the format .hdr or .exr"],
  [/is missing|does not exist/, "needs another file that is not there"],
  [/outside the scene's folder/, "needs a file outside its folder, which is not allowed"],
  [/not a glTF file|not begin with|not a binary glTF/, "is not a glTF file"],
  [/version .* is not 2|not glTF 2/, "is not glTF 2.0, the version that the server reads"],
  [/exceeds? the limit|not enough memory|too large|larger than/, "is too large for this server"],
  [/not supported|neither PNG/, "uses something that this server does not support"],
];

/** `text` is what the importer says about the file. */
export function describeFileError(file: string, text: string): FileError {
  const reason = text.replace(/^.*?cannot be loaded: /, "").replace(/^(name|body): /, "");
  const known = meanings.find(([pattern]) => pattern.test(reason));
  return { sentence: `${file} ${known?.[1] ?? "is damaged"}.`, detail: reason };
}

/** Why loading a scene failed. */
export function describeLoadError(scene: string, error: unknown): FileError {
  if (!(error instanceof RpcError)) return { sentence: (error as Error).message, detail: "" };
  if (error.code === ErrorCode.invalidParams && /cannot be loaded/.test(error.sentence)) {
    return describeFileError(scene, error.sentence);
  }
  if (error.code === ErrorCode.notFound && error.data.path === "name") {
    const hint = /did you (mean .*)/.exec(error.data.reason ?? "")?.[1];
    return { sentence: `There is no scene '${scene}'.`, detail: hint ? `Did you ${hint}` : "" };
  }
  return { sentence: `${scene} was not loaded. ${error.sentence}`, detail: "" };
}
