// The settings of the session as this page knows them: shown at once, confirmed by the server.

import type { JsonObject, JsonValue } from "heliograph/messages.ts";
import { ChannelClosed, type RpcPeer } from "heliograph/rpc.ts";
import {
  type Control,
  type ControlGroup,
  allControls,
  defaultTree,
  describeControls,
} from "heliograph/settings_schema.ts";
import { joinPatches, mergePatch, patchOf, sameValue, valueAt } from "heliograph/settings_tree.ts";
import { Signal } from "../common/signal.ts";
import { UndoHistory, inverseOf } from "./undo_history.ts";

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
  readonly history = new UndoHistory();
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
    this.apply(patchOf(path, value));
  }

  reset(path: string): void {
    this.apply(patchOf(path, null));
  }

  /** A change that can be undone. */
  apply(patch: JsonObject): void {
    this.history.add(patch, inverseOf(patch, this.tree.value));
    this.patch(patch);
  }

  undo(): void {
    const patch = this.history.undo();
    if (patch) this.patch(patch);
  }

  redo(): void {
    const patch = this.history.redo();
    if (patch) this.patch(patch);
  }

  /** Chooses a preset on the server: a patch that only the server knows. */
  async choosePreset(name: string): Promise<JsonObject> {
    const before = this.tree.value;
    const answer = await this.rpc.request<{ applied: JsonObject }>("settings.preset", { name });
    this.history.add(answer.applied, inverseOf(answer.applied, before));
    this.tree.set(mergePatch(this.tree.value, answer.applied, this.defaults));
    return answer.applied;
  }

  /** Whether every one of these values is in effect. */
  matches(settings: JsonObject): boolean {
    return sameValue(mergePatch(this.tree.value, settings, this.defaults), this.tree.value);
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
    if (changed.length > 0) this.apply(patch);
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
