// The parts of the scene that can be changed: lights, materials, environment.

import type { JsonObject } from "heliograph/json.ts";
import type {
  EnvironmentState,
  LightInfo,
  MaterialInfo,
  Methods,
  Notifications,
  SceneInfo,
} from "heliograph/messages.ts";
import { ChannelClosed, type RpcPeer } from "heliograph/rpc.ts";
import { PatchSender } from "../common/patch_sender.ts";
import { Signal } from "../common/signal.ts";
import { type Edits, type Part, editsOf } from "./scene_edits.ts";
import type { ServerCapabilities } from "./server_capabilities.ts";

interface ScenePartsHost {
  rpc: RpcPeer;
  scene: Signal<SceneInfo | null>;
  capabilities: ServerCapabilities;
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
    this.lights.set(merged(this.lights.value, name, patch));
    this.lightSender.push(name, patch as unknown as JsonObject);
  }

  patchMaterial(name: string, patch: Partial<MaterialInfo>): void {
    this.materials.set(merged(this.materials.value, name, patch));
    this.materialSender.push(name, patch as unknown as JsonObject);
  }

  /** Differences from the file, as far as the server tells. */
  edits(): { lights?: Edits; materials?: Edits } {
    return { lights: editsOf(this.lights.value), materials: editsOf(this.materials.value) };
  }

  /** Resets the light to the values of the file. */
  async resetLight(name: string): Promise<void> {
    const light = this.lights.value.find((part) => part.name === name);
    const shown = ["direction", "angular_diameter", "radius", "intensity", "enabled"];
    const patch = resetPatch(light, shown);
    this.takeLight(await this.attempt("lights.patch", { light: name, patch }));
  }

  async resetMaterial(name: string): Promise<void> {
    const material = this.materials.value.find((part) => part.name === name);
    const patch = resetPatch(material, ["base_color", "roughness", "metallic"]);
    this.takeMaterial(await this.attempt("materials.patch", { material: name, patch }));
  }

  async chooseEnvironment(name: string | null): Promise<void> {
    await this.attempt("environment.set", { name });
    await this.read();
  }

  /** Takes a change by another viewer. */
  notified(method: string, params: unknown): void {
    const { light, material } = params as Partial<LightChange & MaterialChange>;
    if (light && !this.lightSender.isBusy(light.name)) this.takeLight({ light });
    if (material && !this.materialSender.isBusy(material.name)) this.takeMaterial({ material });
    if (method === "environment.changed") void this.read();
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

  private async read(): Promise<void> {
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

  private async attempt<Name extends "lights.patch" | "materials.patch" | "environment.set">(
    method: Name,
    params: Methods[Name]["params"],
  ): Promise<Methods[Name]["result"] | null> {
    try {
      return await this.host.rpc.request(method, params);
    } catch (error) {
      this.host.report(error);
      if (!(error instanceof ChannelClosed)) await this.read();
      return null;
    }
  }
}

type LightChange = { light: Notifications["lights.changed"]["light"] };
type MaterialChange = { material: Notifications["materials.changed"]["material"] };

function merged<Item extends Part>(parts: Item[], name: string, patch: Partial<Item>): Item[] {
  return parts.map((part) => (part.name === name ? { ...part, ...patch } : part));
}

/** A patch of nulls for the changed members; without `changed`, for the members shown here. */
function resetPatch(part: Part | undefined, shown: string[]): JsonObject {
  const members = part?.changed ?? shown.filter((member) => part && member in part);
  return Object.fromEntries(members.map((member) => [member, null]));
}
