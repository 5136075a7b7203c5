// The settings of the session as this page knows them: shown at once, confirmed by the server.

import type { JsonObject, JsonValue } from "./protocol/messages.ts";
import { ChannelClosed, type RpcPeer } from "./protocol/rpc.ts";
import {
  type Control,
  type ControlGroup,
  allControls,
  defaultTree,
  describeControls,
} from "./protocol/settings_schema.ts";
import { joinPatches, mergePatch, patchOf, sameValue, valueAt } from "./protocol/settings_tree.ts";
import { Signal } from "./signal.ts";

const noControls: ControlGroup = {
  path: "",
  title: "",
  description: "",
  order: 0,
  controls: [],
  groups: [],
};

export class SettingsStore {
  readonly schema = new Signal<ControlGroup>(noControls);
  readonly tree = new Signal<JsonObject>({});
  private readonly rpc: RpcPeer;
  private readonly failed: (error: unknown) => void;
  private defaults: JsonObject = {};
  private schemaText = "";
  private unsent: JsonObject | null = null;
  private sending = false;

  constructor(rpc: RpcPeer, failed: (error: unknown) => void) {
    this.rpc = rpc;
    this.failed = failed;
  }

  /** Reads schema and values anew, for a new connection. */
  async load(): Promise<void> {
    this.unsent = null;
    const [schema, state] = await Promise.all([
      this.rpc.request<JsonObject>("settings.schema"),
      this.rpc.request<{ settings: JsonObject }>("settings.get"),
    ]);
    const schemaText = JSON.stringify(schema);
    if (schemaText !== this.schemaText) {
      this.schemaText = schemaText;
      const described = describeControls(schema);
      this.defaults = defaultTree(described);
      this.tree.set(state.settings);
      this.schema.set(described);
    } else {
      this.tree.set(state.settings);
    }
  }

  value(path: string): JsonValue | undefined {
    return valueAt(this.tree.value, path);
  }

  isChanged(control: Control): boolean {
    const value = this.value(control.path);
    return (
      control.default !== undefined && value !== undefined && !sameValue(value, control.default)
    );
  }

  change(path: string, value: JsonValue): void {
    this.patch(patchOf(path, value));
  }

  reset(path: string): void {
    this.patch(patchOf(path, null));
  }

  /** Resets the changed settings below a group, except the named paths. */
  resetGroup(group: ControlGroup, except: string[] = []): void {
    const changed = allControls(group).filter(
      (control) => this.isChanged(control) && !except.includes(control.path),
    );
    const patch = changed.reduce<JsonObject>(
      (joined, control) => joinPatches(joined, patchOf(control.path, null)),
      {},
    );
    if (changed.length > 0) this.patch(patch);
  }

  /** Takes a change made by another viewer. */
  receive(patch: JsonObject): void {
    this.tree.set(mergePatch(this.tree.value, patch, this.defaults));
  }

  /** Shows the change now; sends at most one patch at a time, joining what comes meanwhile. */
  private patch(patch: JsonObject): void {
    this.tree.set(mergePatch(this.tree.value, patch, this.defaults));
    this.unsent = this.unsent ? joinPatches(this.unsent, patch) : patch;
    if (!this.sending) void this.send();
  }

  private async send(): Promise<void> {
    this.sending = true;
    while (this.unsent) {
      const patch = this.unsent;
      this.unsent = null;
      try {
        const answer = await this.rpc.request<{ applied: JsonObject }>("settings.patch", { patch });
        const confirmed = mergePatch(this.tree.value, answer.applied, this.defaults);
        this.tree.set(mergePatch(confirmed, this.unsent ?? {}, this.defaults));
      } catch (error) {
        if (error instanceof ChannelClosed) break;
        this.failed(error);
        await this.restore();
      }
    }
    this.sending = false;
  }

  /** After a refusal: back to what the server has. */
  private async restore(): Promise<void> {
    try {
      const state = await this.rpc.request<{ settings: JsonObject }>("settings.get");
      this.tree.set(state.settings);
    } catch {
      // The connection is gone; the next one loads everything.
    }
  }
}
