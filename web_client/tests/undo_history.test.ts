import assert from "node:assert/strict";
import test, { afterEach, mock } from "node:test";
import { UndoHistory } from "../src/session/history/undo_history.ts";
import { inverseOf, pathsOf } from "../src/session/history/settings_steps.ts";

afterEach(() => mock.timers.reset());

test("the inverse of a patch holds the previous values, and only those", () => {
  const tree = { taa: { enabled: true, frames: 8 }, seed: 3 };
  assert.deepEqual(inverseOf({ taa: { enabled: false } }, tree), { taa: { enabled: true } });
  assert.deepEqual(inverseOf({ seed: null }, tree), { seed: 3 });
  assert.deepEqual(pathsOf({ taa: { enabled: false }, seed: null }), ["taa.enabled", "seed"]);
});

/** A history of numbers by name. */
function numbers() {
  let now = 0;
  const values: Record<string, number> = {};
  const history = new UndoHistory(() => now);
  const change = (name: string, value: number, ofScene = false, movement?: number): void => {
    const before = values[name] ?? 0;
    const set = (to: number) => () => void (values[name] = to);
    set(value)();
    const [undo, redo] = [set(before), set(value)];
    history.add({ label: name, key: name, ofScene, movement, undo, redo });
  };
  return { values, history, change, wait: (ms: number) => (now += ms) };
}

test("a drag is one step, another value is another, and steps have names", async () => {
  const { values, history, change, wait } = numbers();
  for (const value of [1, 2, 3]) {
    change("exposure", value);
    wait(100);
  }
  change("sun", 5);
  assert.deepEqual(history.next.value, { undo: "sun", redo: null });
  assert.equal(await history.undo(), "sun");
  assert.deepEqual(history.next.value, { undo: "exposure", redo: "sun" });
  assert.equal(await history.undo(), "exposure");
  assert.deepEqual(values, { exposure: 0, sun: 0 });
  assert.equal(await history.undo(), null);
  assert.equal(await history.redo(), "exposure");
  assert.equal(values.exposure, 3);
  wait(100);
  change("exposure", 9);
  assert.deepEqual(history.next.value, { undo: "exposure", redo: null });
  history.undo();
  assert.equal(values.exposure, 3);
});

test("a movement is one step on a slow page, too, and the next one is another", () => {
  const { values, history, change, wait } = numbers();
  for (const value of [1, 2, 3]) {
    change("camera", value, true, 0);
    wait(2000);
  }
  change("camera", 7, true, 1);
  history.undo();
  assert.equal(values.camera, 3);
  history.undo();
  assert.equal(values.camera, 0);
  history.redo();
  change("camera", 4, true, 0);
  history.undo();
  assert.equal(values.camera, 3, "what was redone is complete");
});

test("what was undone before a scene was seen that does not stay can be done again", async () => {
  const { values, history, change } = numbers();
  change("sun", 5, true);
  history.undo();
  history.enterScene();
  assert.deepEqual(history.next.value, { undo: null, redo: null });
  history.leaveScene();
  assert.deepEqual(history.next.value, { undo: null, redo: "sun" });
  history.redo();
  history.enterScene();
  change("camera", 3, true);
  change("exposure", 2);
  history.leaveScene();
  history.undo();
  assert.equal(values.exposure, 0, "settings stay whatever is seen");
  assert.equal(await history.undo(), "sun");
});

test("steps in a scene that another viewer loads stay, those of the one before do not", async () => {
  const { history, change } = numbers();
  change("sun", 5, true);
  history.enterScene();
  change("camera", 3, true);
  history.dropScene();
  assert.equal(await history.undo(), "camera");
  assert.equal(await history.undo(), null);
});

test("steps in a scene are void when another viewer loads another scene", () => {
  const { values, history, change } = numbers();
  change("exposure", 1);
  change("sun", 5, true);
  history.undo();
  history.dropScene();
  assert.deepEqual(history.next.value, { undo: "exposure", redo: null });
  history.undo();
  assert.deepEqual(values, { exposure: 0, sun: 0 });
});

/** A change that the server answers later. */
function pendingChange<Result>() {
  let answer: (result: Result) => void = () => {};
  let fail: (error: Error) => void = () => {};
  const change = new Promise<Result>((resolve, reject) => ([answer, fail] = [resolve, reject]));
  return { change, answer, fail };
}

const ignore = (): void => {};

test("undo waits for the answer to a change that may add a step", async () => {
  const { values, history, change } = numbers();
  change("exposure", 1);
  const { change: answered, answer } = pendingChange<boolean>();
  const applied = history.during(
    answered.then((taken) => {
      change("sun", 5);
      return taken;
    }),
  );
  history.whenKnown(() => void history.undo(), ignore);
  assert.equal(values.exposure, 1, "the step before is not undone in its place");
  answer(true);
  await applied;
  assert.deepEqual(values, { exposure: 1, sun: 0 });
  assert.deepEqual(history.next.value, { undo: "exposure", redo: "sun" });
});

test("undo that waited for a change that failed was meant for it, and is dropped", async () => {
  const { values, history, change } = numbers();
  change("exposure", 1);
  const undo = (): void => history.whenKnown(() => void history.undo(), ignore);
  for (const refusal of [false, null]) {
    const refused = history.during(Promise.resolve(refusal));
    undo();
    assert.equal(await refused, refusal);
  }
  const lost = history.during(Promise.reject(new Error("lost")));
  undo();
  await assert.rejects(lost);
  assert.equal(values.exposure, 1);
  undo();
  assert.equal(values.exposure, 0, "the next one does not wait");
});

test("undo is meant for the newest change of those without an answer", async () => {
  const { values, history, change } = numbers();
  change("exposure", 1);
  const [replaced, taken, later] = [0, 1, 2].map(() => pendingChange<boolean>());
  const changes = [replaced, taken].map((one) => history.during(one!.change));
  history.whenKnown(() => void history.undo(), ignore);
  const laterEnd = history.during(later!.change);
  replaced!.answer(false);
  await changes[0];
  later!.answer(false);
  await laterEnd;
  assert.equal(values.exposure, 1);
  change("sun", 5);
  taken!.answer(true);
  await changes[1];
  assert.deepEqual(values, { exposure: 1, sun: 0 });
});

test("only the last of undo and redo waits, and a long wait is told", async () => {
  mock.timers.enable(["setTimeout"]);
  const { history } = numbers();
  const { change, answer } = pendingChange<boolean>();
  const ended = history.during(change);
  const told: string[] = [];
  history.whenKnown(() => told.push("undo"), () => told.push("undo waits"));
  history.whenKnown(() => told.push("redo"), () => told.push("redo waits"));
  mock.timers.tick(499);
  assert.deepEqual(told, []);
  mock.timers.tick(1);
  assert.deepEqual(told, ["redo waits"]);
  answer(true);
  await ended;
  assert.deepEqual(told, ["redo waits", "redo"]);
});

test("a wait that has ended is not told", async () => {
  mock.timers.enable(["setTimeout"]);
  const { history } = numbers();
  for (const taken of [true, false]) {
    const ended = history.during(Promise.resolve(taken));
    history.whenKnown(ignore, () => assert.fail("told"));
    await ended;
  }
  mock.timers.tick(1000);
});

test("undo that waits is dropped with the history", async () => {
  const { values, history, change } = numbers();
  const ended = history.during(Promise.resolve(true));
  history.whenKnown(() => void history.undo(), ignore);
  history.clear();
  change("exposure", 1);
  await ended;
  assert.equal(values.exposure, 1);
});

/** An undo or redo that the server answers, and what was asked of it. */
function answered() {
  const asked: ReturnType<typeof pendingChange<boolean>>[] = [];
  const ask = (): Promise<boolean> => {
    asked.push(pendingChange<boolean>());
    return asked.at(-1)!.change;
  };
  return { asked, ask };
}

/** A history with the step "sun" and, on it, "texture", whose undo and redo the server answers. */
function withAnsweredStep() {
  const { history, change, values } = numbers();
  const { asked, ask } = answered();
  change("sun", 5);
  history.add({ label: "texture", key: "texture", ofScene: true, undo: ask, redo: ask });
  return { history, change, values, asked };
}

test("undo and redo are told when the server has taken them", async () => {
  const { history, asked } = withAnsweredStep();
  let told: string | null = null;
  const undone = history.undo().then((label) => (told = label));
  await Promise.resolve();
  assert.equal(told, null);
  assert.deepEqual(history.next.value, { undo: "sun", redo: "texture" });
  asked[0]!.answer(true);
  assert.equal(await undone, "texture");
  const redone = history.redo();
  asked[1]!.answer(true);
  assert.equal(await redone, "texture");
});

test("undo that the server refuses is none: the step can be undone again", async () => {
  const { history, asked } = withAnsweredStep();
  const refused = history.undo();
  asked[0]!.answer(false);
  assert.equal(await refused, null);
  assert.deepEqual(history.next.value, { undo: "texture", redo: null });
  const taken = history.undo();
  asked[1]!.answer(true);
  assert.equal(await taken, "texture");
  assert.deepEqual(history.next.value, { undo: "sun", redo: "texture" });
  const redo = history.redo();
  asked[2]!.answer(false);
  assert.equal(await redo, null);
  assert.deepEqual(history.next.value, { undo: "sun", redo: "texture" });
});

test("a step whose undo is refused once more does not bar those before it", async () => {
  const { history, asked } = withAnsweredStep();
  for (const number of [0, 1]) {
    const refused = history.undo();
    asked[number]!.answer(false);
    assert.equal(await refused, null);
  }
  assert.equal(await history.undo(), "sun");
  assert.deepEqual(history.next.value, { undo: null, redo: "sun" });
});

test("undo that is refused late goes back below what was changed since", async () => {
  const { history, change, values, asked } = withAnsweredStep();
  const refused = history.undo();
  change("exposure", 2);
  asked[0]!.answer(false);
  await refused;
  assert.equal(await history.undo(), "exposure");
  assert.deepEqual(history.next.value, { undo: "texture", redo: "exposure" });
  assert.deepEqual(values, { sun: 5, exposure: 0 });
});

test("redo that is refused after another change is gone", async () => {
  const { history, change, asked } = withAnsweredStep();
  const undone = history.undo();
  asked[0]!.answer(true);
  await undone;
  const refused = history.redo();
  change("exposure", 2);
  asked[1]!.answer(false);
  assert.equal(await refused, null);
  assert.deepEqual(history.next.value, { undo: "exposure", redo: null });
  await history.undo();
  assert.equal(history.next.value.undo, "sun");
});

test("a step in a scene that is gone does not come back when its undo is refused", async () => {
  const { history, asked } = withAnsweredStep();
  const refused = history.undo();
  history.dropScene();
  asked[0]!.answer(false);
  assert.equal(await refused, null);
  assert.deepEqual(history.next.value, { undo: "sun", redo: null });
});

test("undo waits for the answer to the undo before: a refused step is undone first", async () => {
  const { history, asked } = withAnsweredStep();
  const presses = [history.undo(), history.undo(), history.redo()];
  assert.equal(asked.length, 1);
  asked[0]!.answer(false);
  await presses[0];
  await Promise.resolve();
  assert.equal(asked.length, 2, "the same step again");
  asked[1]!.answer(true);
  assert.equal(await presses[1], "texture");
  await Promise.resolve();
  asked[2]!.answer(true);
  assert.deepEqual(await Promise.all(presses), [null, "texture", "texture"]);
  assert.deepEqual(history.next.value, { undo: "texture", redo: null });
});

test("a refused step that is none of a scene keeps its place beside a scene that is seen", async () => {
  const { history } = numbers();
  const { asked, ask } = answered();
  history.add({ label: "environment", key: "environment", undo: ask, redo: ask });
  const undone = history.undo();
  history.enterScene();
  asked[0]!.answer(false);
  assert.equal(await undone, null);
  assert.deepEqual(history.next.value, { undo: null, redo: null });
  history.leaveScene();
  assert.deepEqual(history.next.value, { undo: "environment", redo: null });
  const taken = history.undo();
  asked[1]!.answer(true);
  await taken;
  const redone = history.redo();
  history.enterScene();
  asked[2]!.answer(false);
  assert.equal(await redone, null);
  history.leaveScene();
  assert.deepEqual(history.next.value, { undo: null, redo: "environment" });
});
