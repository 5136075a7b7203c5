import assert from "node:assert/strict";
import test from "node:test";
import { ChannelClosed, type MethodTable, RpcError, RpcPeer } from "heliograph/rpc.ts";

function peer() {
  const sent: { id?: number; method: string; params: unknown }[] = [];
  const received: [string, unknown][] = [];
  const rpc = new RpcPeer<MethodTable>(
    (text) => sent.push(JSON.parse(text)),
    (method, params) => received.push([method, params]),
  );
  rpc.open();
  return { rpc, sent, received };
}

test("answers find their requests in any order, also in a batch", async () => {
  const { rpc, sent } = peer();
  const first = rpc.request("a");
  const second = rpc.request("b", { x: 1 });
  assert.deepEqual(sent[1]?.params, { x: 1 });
  rpc.receive(
    JSON.stringify([
      { jsonrpc: "2.0", id: sent[1]?.id, result: 2 },
      { jsonrpc: "2.0", id: sent[0]?.id, result: 1 },
    ]),
  );
  assert.equal(await first, 1);
  assert.equal(await second, 2);
});

test("an error keeps code and data and reads as one sentence", async () => {
  const { rpc, sent } = peer();
  const pending = rpc.request("scene.load", { name: "x" });
  const error = { code: -32004, message: "No such scene", data: { path: "name", reason: "x" } };
  rpc.receive(JSON.stringify({ jsonrpc: "2.0", id: sent[0]?.id, error }));
  await assert.rejects(pending, (caught: RpcError) => {
    assert.equal(caught.code, -32004);
    assert.equal(caught.data.path, "name");
    assert.equal(caught.sentence, "No such scene: x");
    return true;
  });
});

test("notifications are passed on and have no id", () => {
  const { rpc, sent, received } = peer();
  rpc.notify("stream.ack", { frame_seq: 3 });
  assert.equal("id" in sent[0]!, false);
  rpc.receive('{"jsonrpc":"2.0","method":"stats.frame","params":{"fps":9}}');
  assert.deepEqual(received, [["stats.frame", { fps: 9 }]]);
});

test("a lost channel fails pending requests; invalid and stray answers are ignored", async () => {
  const { rpc } = peer();
  const pending = rpc.request("a");
  rpc.receive("not json");
  rpc.receive("null");
  rpc.receive('{"jsonrpc":"2.0","id":99,"result":0}');
  rpc.close();
  await assert.rejects(pending, ChannelClosed);
  await assert.rejects(rpc.request("b"), ChannelClosed);
});

test("an error without an id fails all pending requests", async () => {
  const { rpc, sent } = peer();
  const pending = [rpc.request("a"), rpc.request("b")];
  const error = { code: -32002, message: "too many messages" };
  rpc.receive(JSON.stringify({ jsonrpc: "2.0", id: null, error }));
  for (const one of pending) {
    await assert.rejects(one, (caught: RpcError) => caught.code === -32002);
  }
  const later = rpc.request("c");
  rpc.receive(JSON.stringify({ jsonrpc: "2.0", id: sent[2]?.id, result: 3 }));
  assert.equal(await later, 3);
});

test("a timeout error names the method", async () => {
  const { rpc } = peer();
  await assert.rejects(rpc.request("slow.method", {}, 10), /slow\.method/);
});
