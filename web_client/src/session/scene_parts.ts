// The parts of the scene that can be changed: lights, materials, environment.

import type { JsonObject, JsonValue } from "heliograph/json.ts";
import type {
  EditDocument,
  EnvironmentState,
  LightAdd,
  LightInfo,
  MaterialInfo,
  Methods,
  Notifications,
  SceneInfo,
} from "heliograph/messages.ts";
import { ChannelClosed, type RpcPeer } from "heliograph/rpc.ts";
import { humanise } from "heliograph/settings_schema.ts";
import { PatchSender } from "../common/patch_sender.ts";
import { Signal } from "../common/signal.ts";
import { type Edits, type Part, addRequest, editsOf } from "./scene_edits.ts";
import type { SceneLoading } from "./scene_loading.ts";
import type { ServerCapabilities } from "./server_capabilities.ts";
import type { UndoHistory } from "./history/undo_history.ts";

const loadTimeoutMs = 600_000;

interface ScenePartsHost {
  rpc: RpcPeer;
  scene: Signal<SceneInfo | null>;
  capabilities: ServerCapabilities;
  history: UndoHistory;
  loading: SceneLoading;
  /** Takes which nodes are hidden and isolated. */
  shows(edits: Pick<EditDocument, "hidden" | "isolated">): void;
  report(error: unknown): void;
}

export class SceneParts {
  readonly lights = new Signal<LightInfo[]>([]);
  readonly materials = new Signal<MaterialInfo[]>([]);
  readonly environment = new Signal<EnvironmentState | null>(null);
  private readonly host: ScenePartsHost;
  private readonly lightSender: PatchSender;
  private readonly materialSender: PatchSender;

  constructor(host: ScenePartsHost) {
    this.host = host;
    this.lightSender = new PatchSender(async (light, patch) => {
      this.takeLight(await this.attempt("lights.patch", { light, patch }));
    });
    this.materialSender = new PatchSender(async (material, patch) => {
      this.takeMaterial(await this.attempt("materials.patch", { material, patch }));
    });
    host.scene.watch(() => void this.read());
    host.capabilities.methods.watch(() => void this.read());
  }

  patchLight(name: string, patch: Partial<LightInfo>): void {
    this.remember(name, patch, this.lights, this.lightSender);
    this.lights.set(merged(this.lights.value, name, patch));
    this.lightSender.push(name, patch as unknown as JsonObject);
  }

  /** Changes a light without a step of the history, as long as a drag lasts. */
  previewLight(name: string, patch: Partial<LightInfo>): void {
    this.lights.set(merged(this.lights.value, name, patch));
    this.lightSender.push(name, patch as unknown as JsonObject);
  }

  /** A step of the history for what was previewed since the light was `before`. */
  recordLight(before: LightInfo, patch: Partial<LightInfo>, label: string, key: string): void {
    this.record(before, patch, { label, key }, this.lights, this.lightSender);
  }

  /** Takes back what was previewed of these members since the light was `before`. */
  restoreLight(before: LightInfo, members: (keyof LightInfo)[]): void {
    const { values, sent } = valuesBefore(before, members);
    this.lights.set(merged(this.lights.value, before.name, values as Partial<LightInfo>));
    this.lightSender.push(before.name, sent);
  }

  patchMaterial(name: string, patch: Partial<MaterialInfo>): void {
    this.remember(name, patch, this.materials, this.materialSender);
    this.materials.set(merged(this.materials.value, name, patch));
    this.materialSender.push(name, patch as unknown as JsonObject);
  }

  /** Adds a light; its name, or null where the server refuses it. */
  addLight(request: LightAdd): Promise<string | null> {
    return this.host.history.during(this.addRecorded(request));
  }

  /** Whether the server takes it. */
  removeLight(name: string): Promise<boolean> {
    return this.host.history.during(this.removeRecorded(name));
  }

  /** Applies a document in place of all edits. Whether the server takes it. */
  applyEdits(edits: EditDocument): Promise<boolean> {
    return this.host.history.during(this.applyRecorded(edits));
  }

  private async addRecorded(request: LightAdd): Promise<string | null> {
    const light = await this.sendLight(request);
    if (!light) return null;
    const again = addRequest(light);
    this.host.history.add({
      label: `add ${light.name}`,
      key: `add ${light.name}`,
      ofScene: true,
      undo: () => this.sendRemoval(light.name),
      redo: async () => (await this.sendLight(again)) !== null,
    });
    return light.name;
  }

  private async removeRecorded(name: string): Promise<boolean> {
    const light = this.lights.value.find((one) => one.name === name);
    if (!light || !(await this.sendRemoval(name))) return false;
    this.host.history.add({
      label: `remove ${name}`,
      key: `remove ${name}`,
      ofScene: true,
      undo: async () => (await this.sendLight(addRequest(light))) !== null,
      redo: () => this.sendRemoval(name),
    });
    return true;
  }

  /** Everything that differs from the scene's file; null where the server refuses. */
  async readEdits(): Promise<EditDocument | null> {
    return (await this.attempt("edits.get", {}))?.edits ?? null;
  }

  private async applyRecorded(edits: EditDocument): Promise<boolean> {
    const before = await this.readEdits();
    if (!before || !(await this.sendEdits(edits))) return false;
    this.host.history.add({
      label: "opened edits",
      key: "opened edits",
      ofScene: true,
      undo: () => this.sendEdits(before),
      redo: () => this.sendEdits(edits),
    });
    return true;
  }

  private async sendLight(request: LightAdd): Promise<LightInfo | null> {
    const answer = await this.attempt("lights.add", request);
    if (answer) await this.read();
    return answer?.light ?? null;
  }

  private async sendRemoval(light: string): Promise<boolean> {
    const answer = await this.attempt("lights.remove", { light });
    if (answer) this.lights.set(answer.lights);
    return answer !== null;
  }

  private async sendEdits(edits: EditDocument): Promise<boolean> {
    const answer = await this.attempt("edits.apply", { edits }, loadTimeoutMs);
    if (!answer) return false;
    this.host.loading.takesEffect(answer.rev); // other textures are loaded
    await this.read();
    this.host.shows(answer.edits);
    return true;
  }

  /** Differences from the file, as far as the server tells. */
  edits(): { lights?: Edits; materials?: Edits } {
    return { lights: editsOf(this.lights.value), materials: editsOf(this.materials.value) };
  }

  /** Resets the light to the values of the file. */
  resetLight(name: string): void {
    const light = this.lights.value.find((part) => part.name === name);
    const shown = ["direction", "angular_diameter", "radius", "intensity", "enabled"];
    const patch = resetPatch(light, shown);
    this.remember(name, patch as object, this.lights, this.lightSender);
    this.lightSender.push(name, patch);
  }

  resetMaterial(name: string): void {
    const material = this.materials.value.find((part) => part.name === name);
    const patch = resetPatch(material, ["base_color", "roughness", "metallic"]);
    this.remember(name, patch as object, this.materials, this.materialSender);
    this.materialSender.push(name, patch);
  }

  /** null: the scene's own. */
  chooseEnvironment(name: string | null): void {
    const before = this.environment.value?.current ?? null;
    if (name === before) return;
    this.host.history.add({
      label: "environment",
      key: `environment ${name}`,
      undo: () => this.setEnvironment(before),
      redo: () => this.setEnvironment(name),
    });
    void this.setEnvironment(name);
  }

  /** Its file may have replaced one that is shown. */
  async showUploadedEnvironment(name: string): Promise<void> {
    if (this.environment.value?.current === name) await this.setEnvironment(name);
    else this.chooseEnvironment(name);
  }

  /** Whether the server takes it. */
  private async setEnvironment(name: string | null): Promise<boolean> {
    const { loading, rpc } = this.host;
    const shown = name ?? "the scene's environment";
    loading.start({ kind: "environment", name: shown, stage: "loading", fraction: 0, by: "" });
    try {
      const state = await rpc.request("environment.set", { name }, loadTimeoutMs);
      this.environment.set(state);
      loading.takesEffect(state.rev);
      return true;
    } catch (error) {
      loading.end();
      this.host.report(error);
      if (!(error instanceof ChannelClosed)) await this.read();
      return false;
    }
  }

  /** A step of the history: the members of the patch as they were before. */
  private remember<Item extends Part>(
    name: string,
    patch: Partial<Item>,
    parts: Signal<Item[]>,
    sender: PatchSender,
  ): void {
    const part = parts.value.find((one) => one.name === name);
    const members = Object.keys(patch);
    if (!part || members.length === 0) return;
    const label =
      members.length === 1 ? `${humanise(members[0] as string).toLowerCase()} of ${name}` : name;
    this.record(part, patch, { label, key: `${name} ${members.join()}` }, parts, sender);
  }

  private record<Item extends Part>(
    before: Item,
    patch: Partial<Item>,
    step: { label: string; key: string },
    parts: Signal<Item[]>,
    sender: PatchSender,
  ): void {
    const { name } = before;
    const { values, sent } = valuesBefore(before, Object.keys(patch));
    this.host.history.add({
      ...step,
      ofScene: true,
      undo: () => {
        parts.set(merged(parts.value, name, values as Partial<Item>));
        sender.push(name, sent);
      },
      redo: () => {
        if (!Object.values(patch).includes(null)) parts.set(merged(parts.value, name, patch));
        sender.push(name, patch as unknown as JsonObject);
      },
    });
  }

  /** Takes a change by another viewer. */
  notified(method: string, params: unknown): void {
    const { light, material } = params as Partial<LightChange & MaterialChange>;
    if (light && !this.lightSender.isBusy(light.name)) this.takeLight({ light });
    if (material && !this.materialSender.isBusy(material.name)) this.takeMaterial({ material });
    if (method === "environment.changed") void this.read();
    if (method === "edits.changed") void this.readAll();
  }

  /** Takes the server's state, unless a newer patch is still to be sent. */
  private takeLight(answer: LightChange | null): void {
    const light = answer?.light;
    if (!light || this.lightSender.hasQueued(light.name)) return;
    this.lights.set(merged(this.lights.value, light.name, light));
  }

  private takeMaterial(answer: MaterialChange | null): void {
    const material = answer?.material;
    if (!material || this.materialSender.hasQueued(material.name)) return;
    this.materials.set(merged(this.materials.value, material.name, material));
  }

  async read(): Promise<void> {
    if (!this.host.scene.value) return;
    const [lights, materials, environment] = await Promise.all([
      this.list("lights.list"),
      this.list("materials.list"),
      this.list("environment.list"),
    ]);
    this.lights.set(lights?.lights ?? []);
    this.materials.set(materials?.materials ?? []);
    this.environment.set(environment);
  }

  /** Files were uploaded or deleted. What is known stays where the server does not answer. */
  async readEnvironments(): Promise<void> {
    const environment = this.host.scene.value && (await this.list("environment.list"));
    if (environment) this.environment.set(environment);
  }

  /** Another viewer has applied a document, or added or removed a light. */
  private async readAll(): Promise<void> {
    await this.read();
    const edits = await this.readEdits();
    if (edits) this.host.shows(edits);
  }

  private async list<Name extends "lights.list" | "materials.list" | "environment.list">(
    method: Name,
  ): Promise<Methods[Name]["result"] | null> {
    if (!this.host.capabilities.has(method)) return null;
    try {
      return await this.host.rpc.request(method, {} as Methods[Name]["params"]);
    } catch {
      return null; // no scene or no connection: it is read again with the next one
    }
  }

  private async attempt<Name extends EditMethod>(
    method: Name,
    params: Methods[Name]["params"],
    timeoutMs?: number,
  ): Promise<Methods[Name]["result"] | null> {
    try {
      return await this.host.rpc.request(method, params, timeoutMs);
    } catch (error) {
      this.host.report(error);
      if (!(error instanceof ChannelClosed)) await this.read();
      return null;
    }
  }
}

type EditMethod =
  | "lights.patch"
  | "lights.add"
  | "lights.remove"
  | "materials.patch"
  | "edits.get"
  | "edits.apply";
type LightChange = { light: Notifications["lights.changed"]["light"] };
type MaterialChange = { material: Notifications["materials.changed"]["material"] };

function merged<Item extends Part>(parts: Item[], name: string, patch: Partial<Item>): Item[] {
  return parts.map((part) => (part.name === name ? { ...part, ...patch } : part));
}

/** Members of a part as they are, to show and to send. */
function valuesBefore(
  part: Part,
  members: readonly string[],
): { values: JsonObject; sent: JsonObject } {
  const shown = part as unknown as JsonObject;
  const pick = (value: (member: string) => JsonValue): JsonObject =>
    Object.fromEntries(members.map((member) => [member, value(member)]));
  const values = pick((member) => shown[member] ?? null);
  // What did not differ from the file is reset, so that it is not marked as changed.
  const sent = pick((member) =>
    part.changed?.includes(member) === false ? null : (shown[member] ?? null),
  );
  return { values, sent };
}

/** A patch of nulls for the changed members; without `changed`, for the members shown here. */
function resetPatch(part: Part | undefined, shown: string[]): JsonObject {
  const members = part?.changed ?? shown.filter((member) => part && member in part);
  return Object.fromEntries(members.map((member) => [member, null]));
}
