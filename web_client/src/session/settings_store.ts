// The settings of the session. Changes show at once and are then confirmed by the server.

import type { JsonObject, JsonValue } from "heliograph/json.ts";
import { ChannelClosed, type RpcPeer } from "heliograph/rpc.ts";
import {
  type Control,
  type ControlGroup,
  allControls,
  defaultTree,
  describeControls,
} from "heliograph/settings_schema.ts";
import { joinPatches, mergePatch, patchOf, sameValue, valueAt } from "heliograph/settings_tree.ts";
import { presetLabel, withPlainLabels } from "../common/labels.ts";
import { Signal } from "../common/signal.ts";
import { describePatch, inverseOf, pathsOf } from "./history/settings_steps.ts";
import type { UndoHistory } from "./history/undo_history.ts";

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
  /** Revision of the session at the newest change that the server has told of. */
  readonly rev = new Signal<number>(0);
  private readonly history: UndoHistory;
  private readonly rpc: RpcPeer;
  private readonly failed: (error: unknown) => void;
  private defaults: JsonObject = {};
  private schemaText = "";
  private unsent: JsonObject | null = null;
  private sending = false;

  constructor(rpc: RpcPeer, history: UndoHistory, failed: (error: unknown) => void) {
    this.rpc = rpc;
    this.history = history;
    this.failed = failed;
  }

  /** Reads schema and values, for a new connection. */
  async load(): Promise<void> {
    this.unsent = null;
    const [schema, state] = await Promise.all([
      this.rpc.request("settings.schema"),
      this.rpc.request("settings.get"),
    ]);
    const schemaText = JSON.stringify(schema);
    if (schemaText !== this.schemaText) {
      this.schemaText = schemaText;
      const described = withPlainLabels(describeControls(schema));
      this.defaults = defaultTree(described);
      this.tree.set(state.settings);
      this.schema.set(described);
    } else {
      this.tree.set(state.settings);
    }
    this.rev.set(state.rev);
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

  /** Applies a change that can be undone. */
  apply(patch: JsonObject): void {
    this.remember(describePatch(this.schema.value, patch), patch, this.tree.value);
    this.patch(patch);
  }

  /** Applies a preset of the server; its result is the patch that it stands for. */
  async choosePreset(name: string): Promise<JsonObject> {
    const before = this.tree.value;
    const answer = await this.rpc.request("settings.preset", { name });
    this.remember(`preset ${presetLabel(name)}`, answer.applied, before);
    this.tree.set(mergePatch(this.tree.value, answer.applied, this.defaults));
    this.rev.set(answer.rev);
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

  /** Takes a change by another viewer. */
  receive({ patch, rev }: { patch: JsonObject; rev: number }): void {
    this.tree.set(mergePatch(this.tree.value, patch, this.defaults));
    this.rev.set(rev);
  }

  private remember(label: string, patch: JsonObject, before: JsonObject): void {
    const inverse = inverseOf(patch, before);
    this.history.add({
      label,
      key: `settings ${pathsOf(patch).sort().join()}`,
      undo: () => this.patch(inverse),
      redo: () => this.patch(patch),
    });
  }

  /** Shows the change now; sends one patch at a time and merges those that arrive during a call. */
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
        const answer = await this.rpc.request("settings.patch", { patch });
        const confirmed = mergePatch(this.tree.value, answer.applied, this.defaults);
        this.tree.set(mergePatch(confirmed, this.unsent ?? {}, this.defaults));
        this.rev.set(answer.rev);
      } catch (error) {
        if (error instanceof ChannelClosed) break;
        this.failed(error);
        await this.restore();
      }
    }
    this.sending = false;
  }

  /** Returns to the server's values after an error. */
  private async restore(): Promise<void> {
    try {
      const state = await this.rpc.request("settings.get");
      this.tree.set(state.settings);
    } catch {
      // The connection is gone; the next one loads everything.
    }
  }
}
