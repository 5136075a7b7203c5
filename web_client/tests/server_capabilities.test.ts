import assert from "node:assert/strict";
import test from "node:test";
import { RpcPeer } from "heliograph/rpc.ts";
import { ServerCapabilities } from "../src/session/server_capabilities.ts";

/** A server whose frames have other buffers each time that the list is read. */
function connected() {
  let reads = 0;
  const rpc: RpcPeer = new RpcPeer(
    (text) => {
      const { id } = JSON.parse(text) as { id: number };
      reads += 1;
      const result = { buffers: [{ name: `buffer ${reads}`, description: "" }] };
      rpc.receive(JSON.stringify({ jsonrpc: "2.0", id, result }));
    },
    () => {},
  );
  rpc.open();
  return { capabilities: new ServerCapabilities(rpc), reads: () => reads };
}

test("the list of buffers is read with the first frame of a change, however late it comes", async () => {
  const { capabilities, reads } = connected();
  await capabilities.frameDrawn(4);
  await capabilities.changedAt(7);
  for (let frame = 0; frame < 20; frame += 1) await capabilities.frameDrawn(6);
  assert.equal(reads(), 0);
  await capabilities.frameDrawn(7);
  assert.deepEqual(
    capabilities.buffers.value.map(({ name }) => name),
    ["buffer 1"],
  );
  await capabilities.frameDrawn(8);
  assert.equal(reads(), 1);
});

test("the list is read at once where the frame came before the answer to the change", async () => {
  const { capabilities, reads } = connected();
  await capabilities.frameDrawn(9);
  await capabilities.changedAt(9);
  assert.equal(reads(), 1);
});

test("frames of another session are not compared with changes of this one", async () => {
  const { capabilities, reads } = connected();
  await capabilities.changedAt(2);
  capabilities.reset();
  await capabilities.frameDrawn(50);
  assert.equal(reads(), 0);
});
