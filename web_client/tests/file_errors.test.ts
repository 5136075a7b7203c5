import assert from "node:assert/strict";
import test from "node:test";
import { RpcError } from "heliograph/rpc.ts";
import { describeFileError, describeLoadError } from "../src/session/file_errors.ts";

test("errors of files are in the user's words, with the importer's as detail", () => {
  const cases: [string, string][] = [
    [
      "GLB is truncated: its header claims more bytes",
      "fox.glb is incomplete: the file ends early.",
    ],
    [
      "body: does not have the length that its header states",
      "fox.glb is incomplete: the file ends early.",
    ],
    ["GLB version 1 is not 2", "fox.glb is not glTF 2.0, the version that the server reads."],
    ["not a glTF file: JSON syntax error at byte 7", "fox.glb is not a glTF file."],
    [
      "images[0] is KTX2 (KHR_texture_basisu), which is not supported",
      "fox.glb uses something that this server does not support.",
    ],
    ["accessors[3].count: must be positive", "fox.glb is damaged."],
  ];
  for (const [text, sentence] of cases) {
    const error = describeFileError("fox.glb", text);
    assert.equal(error.sentence, sentence);
    assert.equal(error.detail, text.replace("body: ", ""));
  }
});

test("a load fails because of its file, its name or something else", () => {
  const reason = "cannot be loaded: GLB is truncated: its header claims more bytes";
  const file = new RpcError(-32602, `name: ${reason}`, { path: "name", reason });
  assert.equal(describeLoadError("fox", file).sentence, "fox is incomplete: the file ends early.");
  const data = { path: "name", reason: "is not in the catalogue; did you mean fox?" };
  assert.deepEqual(describeLoadError("fix", new RpcError(-32004, "name: is not", data)), {
    sentence: "There is no scene 'fix'.",
    detail: "Did you mean fox?",
  });
  const busy = new RpcError(-32050, "the server is shutting down");
  assert.equal(
    describeLoadError("fox", busy).sentence,
    "fox was not loaded. the server is shutting down",
  );
});
