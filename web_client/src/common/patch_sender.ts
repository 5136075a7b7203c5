// Sends patches of one thing after another: what comes while one is under way is joined, so that a
// drag never queues up.

import type { JsonObject } from "heliograph/messages.ts";
import { joinPatches } from "heliograph/settings_tree.ts";

export class PatchSender {
  private readonly send: (key: string, patch: JsonObject) => Promise<void>;
  private readonly waiting = new Map<string, JsonObject>();
  private readonly busy = new Set<string>();

  /** `send` deals with its own failures. */
  constructor(send: (key: string, patch: JsonObject) => Promise<void>) {
    this.send = send;
  }

  /** Whether something about this thing has not been answered yet. */
  unsettled(key: string): boolean {
    return this.busy.has(key) || this.waiting.has(key);
  }

  /** Whether something newer than what is under way has still to be sent. */
  waits(key: string): boolean {
    return this.waiting.has(key);
  }

  push(key: string, patch: JsonObject): void {
    this.waiting.set(key, joinPatches(this.waiting.get(key) ?? {}, patch));
    if (!this.busy.has(key)) void this.run(key);
  }

  private async run(key: string): Promise<void> {
    this.busy.add(key);
    for (let patch = this.waiting.get(key); patch; patch = this.waiting.get(key)) {
      this.waiting.delete(key);
      await this.send(key, patch);
    }
    this.busy.delete(key);
  }
}
