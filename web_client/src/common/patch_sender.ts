// Sends patches of one object after another. Patches that arrive during a call are merged, so that
// a drag never builds up a queue.

import type { JsonObject } from "heliograph/json.ts";
import { joinPatches } from "heliograph/settings_tree.ts";

export class PatchSender {
  private readonly send: (key: string, patch: JsonObject) => Promise<void>;
  private readonly queued = new Map<string, JsonObject>();
  private readonly sending = new Set<string>();

  /** `send` handles its own errors. */
  constructor(send: (key: string, patch: JsonObject) => Promise<void>) {
    this.send = send;
  }

  /** Whether a patch of this object is queued or unanswered. */
  isBusy(key: string): boolean {
    return this.sending.has(key) || this.queued.has(key);
  }

  /** Whether a patch of this object is still to be sent. */
  hasQueued(key: string): boolean {
    return this.queued.has(key);
  }

  push(key: string, patch: JsonObject): void {
    this.queued.set(key, joinPatches(this.queued.get(key) ?? {}, patch));
    if (!this.sending.has(key)) void this.run(key);
  }

  private async run(key: string): Promise<void> {
    this.sending.add(key);
    for (let patch = this.queued.get(key); patch; patch = this.queued.get(key)) {
      this.queued.delete(key);
      await this.send(key, patch);
    }
    this.sending.delete(key);
  }
}
