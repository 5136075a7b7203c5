// What is in the scene and can be changed: lights, materials, environment.

import type {
  EnvironmentState,
  JsonObject,
  LightInfo,
  MaterialInfo,
  SceneInfo,
} from "heliograph/messages.ts";
import { ChannelClosed, type RpcPeer } from "heliograph/rpc.ts";
import { PatchSender } from "../common/patch_sender.ts";
import { type Edits, type Part, editsOf } from "./scene_edits.ts";
import { Signal } from "../common/signal.ts";
import type { ServerCapabilities } from "./server_capabilities.ts";

export interface ScenePartsHost {
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

  /** What differs from the file, as far as the server tells. */
  edits(): { lights?: Edits; materials?: Edits } {
    return { lights: editsOf(this.lights.value), materials: editsOf(this.materials.value) };
  }

  /** Back to what the file says. */
  async resetLight(name: string): Promise<void> {
    const light = this.lights.value.find((one) => one.name === name);
    const shown = ["direction", "angular_diameter", "radius", "intensity", "enabled"];
    const patch = resetting(light, shown);
    this.takeLight(await this.attempt("lights.patch", { light: name, patch }));
  }

  async resetMaterial(name: string): Promise<void> {
    const material = this.materials.value.find((one) => one.name === name);
    const patch = resetting(material, ["base_color", "roughness", "metallic"]);
    this.takeMaterial(await this.attempt("materials.patch", { material: name, patch }));
  }

  async chooseEnvironment(name: string | null): Promise<void> {
    await this.attempt("environment.set", { name });
    await this.read();
  }

  /** Takes a change made by another viewer. */
  notified(method: string, params: unknown): void {
    const { light, material } = params as Partial<LightAnswer & MaterialAnswer>;
    if (light && !this.lightSender.unsettled(light.name)) this.takeLight({ light });
    if (material && !this.materialSender.unsettled(material.name)) this.takeMaterial({ material });
    if (method === "environment.changed") void this.read();
  }

  /** What the server has, unless something newer has still to be sent there. */
  private takeLight(answer: LightAnswer | null): void {
    const light = answer?.light;
    if (!light || this.lightSender.waits(light.name)) return;
    this.lights.set(merged(this.lights.value, light.name, light));
  }

  private takeMaterial(answer: MaterialAnswer | null): void {
    const material = answer?.material;
    if (!material || this.materialSender.waits(material.name)) return;
    this.materials.set(merged(this.materials.value, material.name, material));
  }

  private async read(): Promise<void> {
    if (!this.host.scene.value) return;
    const [lights, materials, environment] = await Promise.all([
      this.ask<{ lights: LightInfo[] }>("lights.list"),
      this.ask<{ materials: MaterialInfo[] }>("materials.list"),
      this.ask<EnvironmentState>("environment.list"),
    ]);
    this.lights.set(lights?.lights ?? []);
    this.materials.set(materials?.materials ?? []);
    this.environment.set(environment);
  }

  private async ask<Answer>(method: string): Promise<Answer | null> {
    if (!this.host.capabilities.has(method)) return null;
    try {
      return await this.host.rpc.request<Answer>(method);
    } catch {
      return null; // no scene yet, or the connection is gone: asked again with the next
    }
  }

  private async attempt<Answer>(method: string, params: object): Promise<Answer | null> {
    try {
      return await this.host.rpc.request<Answer>(method, params);
    } catch (error) {
      this.host.report(error);
      if (!(error instanceof ChannelClosed)) await this.read();
      return null;
    }
  }
}

interface LightAnswer {
  light: LightInfo;
}

interface MaterialAnswer {
  material: MaterialInfo;
}

function merged<One extends Part>(parts: One[], name: string, patch: Partial<One>): One[] {
  return parts.map((part) => (part.name === name ? { ...part, ...patch } : part));
}

/** Resets what differs; where the server does not tell, what can be changed here and is there. */
function resetting(part: Part | undefined, shown: string[]): JsonObject {
  const members = part?.changed ?? shown.filter((member) => part && member in part);
  return Object.fromEntries(members.map((member) => [member, null]));
}
