import assert from "node:assert/strict";
import test, { mock } from "node:test";
import type { Vector3 } from "heliograph/json.ts";
import type { PointerSetParams, SessionInfo, ViewerInfo } from "heliograph/messages.ts";
import { type CameraPose, targetPlaneAt } from "../../src/common/camera_pose.ts";
import { Signal } from "../../src/common/signal.ts";
import { Company } from "../../src/session/company/company.ts";
import { Pointers } from "../../src/session/company/pointers.ts";
import type { DrawnFrame } from "../../src/stream/worker_messages.ts";

const settled = async (): Promise<void> => {
  for (let i = 0; i < 5; i += 1) await Promise.resolve();
};

/** Pointers of a page; `surfaces` answers in turn, then the surface is where the pointer is. */
function page({ company = true, surfaces = [] as (Vector3 | null)[] } = {}) {
  const sent: PointerSetParams[] = [];
  const pointers = new Pointers({
    send: (params) => sent.push(params),
    hasCompany: () => company,
    surfaceAt: async ({ x, y }) => (surfaces.length > 0 ? surfaces.shift()! : [x, y, 0]),
    targetPlaneAt: () => [9, 9, 9],
  });
  return { sent, pointers };
}

test("of many movements the newest is sent, at most 15 a second", async () => {
  mock.timers.enable(["setTimeout"]);
  try {
    const { sent, pointers } = page();
    for (const x of [0.1, 0.2, 0.3]) pointers.movedTo({ x, y: 0.5 });
    await settled();
    pointers.movedTo({ x: 0.4, y: 0.5 });
    await settled();
    assert.deepEqual(sent, [{ position: [0.1, 0.5, 0] }]);
    mock.timers.tick(66);
    await settled();
    assert.equal(sent.length, 1);
    mock.timers.tick(10);
    await settled();
    assert.deepEqual(sent[1], { position: [0.4, 0.5, 0] });
    mock.timers.tick(1000);
    await settled();
    assert.equal(sent.length, 2, "nothing has moved");
    pointers.left();
    pointers.left();
    assert.deepEqual(sent.slice(2), [{}]);
  } finally {
    mock.timers.reset();
  }
});

test("beside all surfaces the point lies at the target's distance", async () => {
  const { sent, pointers } = page({ surfaces: [null] });
  pointers.movedTo({ x: 0.5, y: 0.5 });
  await settled();
  assert.deepEqual(sent, [{ position: [9, 9, 9] }]);
  const camera: CameraPose = {
    eye: [0, 0, 10],
    target: [0, 0, 0],
    up: [0, 1, 0],
    vertical_fov: 90,
    name: null,
  };
  const corner = targetPlaneAt(camera, 2, { x: 1, y: 0 });
  corner.forEach((value, axis) => assert.ok(Math.abs(value - [20, 10, 0][axis]!) < 1e-9));
});

test("nothing is sent without company, after leaving, or when it is switched off", async () => {
  const alone = page({ company: false });
  alone.pointers.movedTo({ x: 0.5, y: 0.5 });
  await settled();
  alone.pointers.left();
  assert.deepEqual(alone.sent, []);
  const gone = page();
  gone.pointers.movedTo({ x: 0.5, y: 0.5 });
  gone.pointers.left();
  await settled();
  assert.deepEqual(gone.sent, [], "it left before the surface was known");
  const { sent, pointers } = page();
  pointers.movedTo({ x: 0.5, y: 0.5 });
  await settled();
  pointers.share(false);
  pointers.movedTo({ x: 0.6, y: 0.5 });
  await settled();
  assert.deepEqual(sent, [{ position: [0.5, 0.5, 0] }, {}]);
});

test("pointers of others fade after five seconds and end", () => {
  mock.timers.enable(["setTimeout"]);
  try {
    const { pointers } = page();
    const told = { viewer: "v2", name: "Ada", position: [1, 2, 3] as Vector3 };
    pointers.take(told);
    mock.timers.tick(4000);
    pointers.take({ ...told, position: [1, 2, 4] });
    mock.timers.tick(4000);
    assert.deepEqual(pointers.others.value, [{ ...told, position: [1, 2, 4], faded: false }]);
    mock.timers.tick(1001);
    assert.equal(pointers.others.value[0]?.faded, true);
    pointers.take(told);
    assert.equal(pointers.others.value[0]?.faded, false, "it moves again");
    pointers.take({ ...told, position: null });
    assert.deepEqual(pointers.others.value, []);
    pointers.take(told);
    pointers.forget(false);
    assert.equal(pointers.others.value.length, 1);
    pointers.forget(true);
    mock.timers.tick(6000);
    assert.deepEqual(pointers.others.value, []);
  } finally {
    mock.timers.reset();
  }
});

function viewer(id: string, name: string | null = null): ViewerInfo {
  return { viewer: id, name, control: true, you: false };
}

function session(name: string, viewers: ViewerInfo[], follows?: string): SessionInfo {
  const size = { width: 640, height: 360 };
  const rest = { scene: null, control: "shared" as const, rev: 1, idle_seconds: 0, device: 0 };
  return { name, viewers, ...size, ...rest, ...(follows ? { follows } : {}) };
}

/** A page in one of these sessions. */
function companyIn(own: SessionInfo, sessions: SessionInfo[]) {
  const sent: string[] = [];
  const company = new Company({
    rpc: {
      request: async () => ({ sessions }),
      notify: (method: string) => void sent.push(method),
    } as unknown as ConstructorParameters<typeof Company>[0]["rpc"],
    membership: { session: new Signal<SessionInfo | null>(own) },
    capabilities: { methods: new Signal<ReadonlySet<string>>(new Set()), has: () => true },
    queries: { surfaceAt: async () => [0, 0, 0] },
    camera: new Signal<CameraPose | null>(null),
    frame: new Signal<DrawnFrame | null>(null),
    inFrame: (x, y) => ({ x, y }),
  });
  return { company, sent };
}

test("company are those who share the scene, with the same camera or their own", async () => {
  const main = session("main", [viewer("v1")]);
  const ada = session("session-1", [viewer("v2", "Ada")], "main");
  const bob = session("session-2", [viewer("v3")], "main");
  const others = session("other", [viewer("v4")]);
  const all = [main, others, ada, bob, session("session-3", [viewer("v5")], "other")];
  const told = async (own: SessionInfo): Promise<[string, boolean][]> => {
    const { company } = companyIn(own, all);
    await company.read();
    return company.elsewhere.value.map((one) => [one.viewer, one.looksAround]);
  };
  assert.deepEqual(await told(main), [["v2", true], ["v3", true]]);
  assert.deepEqual(await told(ada), [["v1", false], ["v3", true]]);
});

test("a page points for viewers in other sessions, too, and not when it is alone", async () => {
  const main = session("main", [viewer("v1")]);
  const alone = companyIn(main, [main]);
  await alone.company.read();
  alone.company.pointers.movedTo({ x: 0.5, y: 0.5 });
  await settled();
  assert.deepEqual(alone.sent, []);
  const { company, sent } = companyIn(main, [main, session("s", [viewer("v2")], "main")]);
  await company.read();
  company.pointers.movedTo({ x: 0.5, y: 0.5 });
  await settled();
  assert.deepEqual(sent, ["pointer.set"]);
});
