// One history of everything that this page changes: settings, lights, materials, environment,
// camera, scene. All changes of one drag are one step.

import { Signal } from "../../common/signal.ts";

export interface Step {
  /** What was changed, as in "Undo: exposure". */
  label: string;
  /** Steps in quick succession with the same key are one. */
  key: string;
  /** So are those of one movement, however slowly they come. */
  movement?: number | undefined;
  /** It concerns the content of a scene and is void when another viewer loads another one. */
  ofScene?: boolean;
  /**
   * False where the server does not take it, which is told unless the connection was lost. Without
   * a result it is done.
   */
  undo(): void | Promise<boolean>;
  redo(): void | Promise<boolean>;
}

interface Entry extends Step {
  /** When it was added or continued, in milliseconds; -Infinity: nothing continues it. */
  at: number;
  /** Whether the server has refused its undo or redo the last time. */
  refused: boolean;
}

/** While a scene is seen that may not stay: what was done, a number, and undone before it. */
interface BeforeScene {
  done: number;
  undone: Entry[];
}

/** The labels of the next steps; null where there is none. */
interface NextSteps {
  undo: string | null;
  redo: string | null;
}

/** Whether it outlives its scene. */
function stays({ ofScene }: Step): boolean {
  return !ofScene;
}

/** Whether a step that was refused may be tried again. */
function comesAgain(step: Entry): boolean {
  const first = !step.refused;
  step.refused = true;
  return first;
}

/** Undo or redo that was asked for while changes were without an answer. */
interface Waiting {
  act: () => void;
  awaited: Set<Promise<unknown>>;
  /** The newest of them: what is to be undone. */
  meant: Promise<unknown>;
  timer: ReturnType<typeof setTimeout>;
}

const mergeWithinMs = 900;
/** A wait that is longer is told. */
const shortWaitMs = 500;
const maxSteps = 200;

export class UndoHistory {
  readonly next = new Signal<NextSteps>({ undo: null, redo: null });
  private done: Entry[] = [];
  private undone: Entry[] = [];
  private before: BeforeScene | null = null;
  /** How often the history was cleared, and how often the scene was another one. */
  private clears = 0;
  private scenes = 0;
  private additions = 0;
  /** Ends with the answer to the undo or redo that waits for one. */
  private turn: Promise<unknown> | null = null;
  /** Changes that the server has not answered: each may still add a step. */
  private readonly unanswered = new Set<Promise<unknown>>();
  private waiting: Waiting | null = null;
  private readonly clock: () => number;

  constructor(clock: () => number = () => performance.now()) {
    this.clock = clock;
  }

  /**
   * Holds back what is passed to `whenKnown` until `change` ends, which adds its step when the
   * server has taken it: what is undone then is that change, not the one before. The result is
   * false or null where it was not taken.
   */
  async during<Result extends string | boolean | null>(change: Promise<Result>): Promise<Result> {
    this.unanswered.add(change);
    let taken = false;
    try {
      const result = await change;
      taken = result !== null && result !== false;
      return result;
    } finally {
      this.answered(change, taken);
    }
  }

  /**
   * Calls `act`, which undoes or redoes, as soon as the changes of now are answered; not at all
   * when the newest of them fails, which it was meant for. Only the last `act` waits, and `waits`
   * is called when that takes a while.
   */
  whenKnown(act: () => void, waits: () => void): void {
    this.stopWaiting();
    const awaited = new Set(this.unanswered);
    const meant = [...awaited].at(-1);
    if (!meant) act();
    else this.waiting = { act, awaited, meant, timer: setTimeout(waits, shortWaitMs) };
  }

  /** Adds a change that was made. */
  add(step: Step): void {
    const at = this.clock();
    const last = this.reachable ? this.done[this.done.length - 1] : undefined;
    this.undone = [];
    this.additions += 1;
    const continues = step.movement !== undefined && step.movement === last?.movement;
    if (last && last.key === step.key && (continues || at - last.at < mergeWithinMs)) {
      last.redo = step.redo;
      last.at = at;
      last.movement = step.movement;
    } else {
      this.done.push({ ...step, at, refused: false });
      if (this.done.length > maxSteps) this.dropOldest();
    }
    this.announce();
  }

  /**
   * Undoes the last step, when the undo or redo before has its answer. Its label when it is taken;
   * null without a step, or where the server refuses it. Then the step is the next again, and goes
   * when it is refused once more: those before it could never be undone.
   */
  undo(): Promise<string | null> {
    if (this.turn) return this.turn.then(() => this.undo());
    const step = this.reachable ? this.done.pop() : undefined;
    if (!step) return Promise.resolve(null);
    const [at, { before }] = [this.done.length, this];
    this.undone.push(step);
    const answer = step.undo();
    this.announce();
    return this.whenTaken(step, answer, () => this.keepDone(step, at, before));
  }

  /** The same for the last step that was undone. */
  redo(): Promise<string | null> {
    if (this.turn) return this.turn.then(() => this.redo());
    const step = this.undone.pop();
    if (!step) return Promise.resolve(null);
    const { additions, before } = this;
    Object.assign(step, { at: -Infinity, movement: undefined });
    this.done.push(step);
    const answer = step.redo();
    this.announce();
    return this.whenTaken(step, answer, () => this.keepUndone(step, additions, before));
  }

  /** A scene is seen that is being loaded: steps of the one before wait until it stays or goes. */
  enterScene(): void {
    if (this.before) return;
    this.scenes += 1;
    this.before = { done: this.done.length, undone: this.undone };
    this.undone = [];
    this.announce();
  }

  /** The scene stays. `step` is what has led to it, before all steps in it; null: none is added. */
  keepScene(step: Step | null): void {
    if (!this.before) {
      if (step) this.add(step);
      return;
    }
    const { done } = this.before;
    this.scenes += 1;
    if (!step) this.redoAgain();
    else this.done.splice(done, 0, { ...step, at: this.clock(), refused: false });
    this.before = null;
    if (this.done.length > maxSteps) this.dropOldest();
    this.announce();
  }

  /** The scene goes, and the steps in it. */
  leaveScene(): void {
    if (!this.before) return;
    const { done } = this.before;
    this.scenes += 1;
    this.redoAgain();
    this.done = [...this.done.slice(0, done), ...this.done.slice(done).filter(stays)];
    this.undone = this.undone === this.before.undone ? this.undone : this.undone.filter(stays);
    this.before = null;
    this.announce();
  }

  /** Another viewer has loaded another scene: that which was seen, if there was one. */
  dropScene(): void {
    const done = this.before?.done ?? this.done.length;
    this.scenes += 1;
    if (this.before) this.before.undone = this.before.undone.filter(stays);
    else this.undone = this.undone.filter(stays);
    this.redoAgain();
    this.done = [...this.done.slice(0, done).filter(stays), ...this.done.slice(done)];
    this.before = null;
    this.announce();
  }

  clear(): void {
    this.clears += 1;
    this.done = [];
    this.undone = [];
    this.before = null;
    this.stopWaiting();
    this.announce();
  }

  private whenTaken(
    step: Entry,
    answer: void | Promise<boolean>,
    refused: () => void,
  ): Promise<string | null> {
    if (!answer) return Promise.resolve(step.label);
    const { clears, scenes } = this;
    const told = answer
      .catch(() => false)
      .then((taken) => {
        this.turn = null;
        if (taken) step.refused = false;
        // What concerns a scene that is gone does not come back.
        else if (step.ofScene ? scenes === this.scenes : clears === this.clears) refused();
        return taken ? step.label : null;
      });
    this.turn = told;
    return told;
  }

  /** A step that was not undone goes back where it was: below what was changed since. */
  private keepDone(step: Entry, at: number, before: BeforeScene | null): void {
    const others = (steps: Entry[]): Entry[] => steps.filter((one) => one !== step);
    this.undone = others(this.undone);
    if (this.before) this.before.undone = others(this.before.undone);
    if (comesAgain(step)) {
      this.done.splice(at, 0, step);
      if (this.before !== before && this.before) this.before.done += 1;
    }
    this.announce();
  }

  /** A step that was not done again can be tried again, unless something was changed since. */
  private keepUndone(step: Entry, additions: number, before: BeforeScene | null): void {
    const at = this.done.indexOf(step);
    if (at < 0) return;
    this.done.splice(at, 1);
    const entered = this.before !== before ? this.before : null;
    if (entered) entered.done -= 1;
    const undone = entered ? entered.undone : this.undone;
    if (comesAgain(step) && additions === this.additions) undone.push(step);
    this.announce();
  }

  private answered(change: Promise<unknown>, taken: boolean): void {
    this.unanswered.delete(change);
    const { waiting } = this;
    if (!waiting?.awaited.delete(change)) return;
    const failed = change === waiting.meant && !taken;
    if (!failed && waiting.awaited.size > 0) return;
    this.stopWaiting();
    if (!failed) waiting.act();
  }

  private stopWaiting(): void {
    clearTimeout(this.waiting?.timer);
    this.waiting = null;
  }

  /** Whether the last step that was done may be undone now. */
  private get reachable(): boolean {
    return this.done.length > (this.before?.done ?? 0);
  }

  /** What was undone before the scene was seen can be done again, unless it was changed since. */
  private redoAgain(): void {
    if (!this.before || this.reachable || this.undone.length > 0) return;
    this.undone = this.before.undone;
  }

  private dropOldest(): void {
    this.done.shift();
    if (this.before) this.before.done = Math.max(0, this.before.done - 1);
  }

  private announce(): void {
    const label = (steps: Step[]): string | null => steps[steps.length - 1]?.label ?? null;
    this.next.set({ undo: this.reachable ? label(this.done) : null, redo: label(this.undone) });
  }
}
