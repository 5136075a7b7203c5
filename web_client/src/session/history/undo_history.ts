// One history of everything that this page changes: settings, lights, materials, environment,
// camera, scene. All changes of one drag are one step.

import { Signal } from "../../common/signal.ts";

interface Step {
  /** What was changed, as in "Undo: exposure". */
  label: string;
  /** Steps in quick succession with the same key are one. */
  key: string;
  /** So are those of one movement, however slowly they come. */
  movement?: number | undefined;
  /** It concerns the content of a scene and is void when another viewer loads another one. */
  ofScene?: boolean;
  undo(): void;
  redo(): void;
}

/** The labels of the next steps; null where there is none. */
interface NextSteps {
  undo: string | null;
  redo: string | null;
}

const mergeWithinMs = 900;
const maxSteps = 200;

export class UndoHistory {
  readonly next = new Signal<NextSteps>({ undo: null, redo: null });
  private done: (Step & { at: number })[] = [];
  private undone: Step[] = [];
  private readonly clock: () => number;

  constructor(clock: () => number = () => performance.now()) {
    this.clock = clock;
  }

  /** Adds a change that was made. */
  add(step: Step): void {
    const at = this.clock();
    const last = this.done[this.done.length - 1];
    this.undone = [];
    const continues = step.movement !== undefined && step.movement === last?.movement;
    if (last && last.key === step.key && (continues || at - last.at < mergeWithinMs)) {
      last.redo = step.redo;
      last.at = at;
      last.movement = step.movement;
    } else {
      this.done.push({ ...step, at });
      if (this.done.length > maxSteps) this.done.shift();
    }
    this.announce();
  }

  /** Undoes the last step. Returns its label, or null without one. */
  undo(): string | null {
    const step = this.done.pop();
    if (!step) return null;
    this.undone.push(step);
    step.undo();
    this.announce();
    return step.label;
  }

  redo(): string | null {
    const step = this.undone.pop();
    if (!step) return null;
    this.done.push({ ...step, at: -Infinity, movement: undefined });
    step.redo();
    this.announce();
    return step.label;
  }

  /** Another viewer has loaded another scene. */
  dropScene(): void {
    const stays = ({ ofScene }: Step): boolean => !ofScene;
    this.done = this.done.filter(stays);
    this.undone = this.undone.filter(stays);
    this.announce();
  }

  clear(): void {
    this.done = [];
    this.undone = [];
    this.announce();
  }

  private announce(): void {
    const label = (steps: Step[]): string | null => steps[steps.length - 1]?.label ?? null;
    this.next.set({ undo: label(this.done), redo: label(this.undone) });
  }
}
