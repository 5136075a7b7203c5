// What is in the scene and can be changed: lights, materials, environment.

import type {
  EnvironmentState,
  JsonObject,
  LightInfo,
  MaterialInfo,
} from "heliograph/messages.ts";
import { ChannelClosed } from "heliograph/rpc.ts";
import { LatestSender } from "./latest_sender.ts";
import { Signal } from "./signal.ts";
import type { Viewer } from "./viewer.ts";

interface Named {
  name: string;
}

export class SceneParts {
  readonly lights = new Signal<LightInfo[]>([]);
  readonly materials = new Signal<MaterialInfo[]>([]);
  readonly environment = new Signal<EnvironmentState | null>(null);
  private readonly viewer: Viewer;
  private readonly lightSender: LatestSender;
  private readonly materialSender: LatestSender;

  constructor(viewer: Viewer) {
    this.viewer = viewer;
    this.lightSender = new LatestSender((light, patch) =>
      this.attempt("lights.patch", { light, patch }),
    );
    this.materialSender = new LatestSender((material, patch) =>
      this.attempt("materials.patch", { material, patch }),
    );
    viewer.scene.watch(() => void this.read());
    viewer.methods.watch(() => void this.read());
  }

  patchLight(name: string, patch: Partial<LightInfo>): void {
    this.lights.set(merged(this.lights.value, name, patch));
    this.lightSender.push(name, patch as unknown as JsonObject);
  }

  patchMaterial(name: string, patch: Partial<MaterialInfo>): void {
    this.materials.set(merged(this.materials.value, name, patch));
    this.materialSender.push(name, patch as unknown as JsonObject);
  }

  /** Back to what the file says. */
  async resetLight(name: string): Promise<void> {
    const patch = { direction: null, angular_diameter: null, intensity: null, enabled: null };
    await this.attempt("lights.patch", { light: name, patch });
    await this.read();
  }

  async resetMaterial(name: string): Promise<void> {
    const patch = { base_color: null, roughness: null, metallic: null };
    await this.attempt("materials.patch", { material: name, patch });
    await this.read();
  }

  async chooseEnvironment(name: string | null): Promise<void> {
    await this.attempt("environment.set", { name });
    await this.read();
  }

  /** Takes a change made by another viewer. */
  notified(method: string, params: unknown): void {
    const { light, material } = params as { light?: LightInfo; material?: MaterialInfo };
    if (method === "lights.changed" && light && !this.lightSender.unsettled(light.name)) {
      this.lights.set(merged(this.lights.value, light.name, light));
    } else if (method === "materials.changed" && material) {
      if (this.materialSender.unsettled(material.name)) return;
      this.materials.set(merged(this.materials.value, material.name, material));
    } else if (method === "environment.changed") {
      void this.read();
    }
  }

  private async read(): Promise<void> {
    if (!this.viewer.scene.value) return;
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
    if (!this.viewer.methods.value.has(method)) return null;
    try {
      return await this.viewer.rpc.request<Answer>(method);
    } catch {
      return null; // no scene yet, or the connection is gone: asked again with the next
    }
  }

  private async attempt(method: string, params: object): Promise<void> {
    try {
      await this.viewer.rpc.request(method, params);
    } catch (error) {
      this.viewer.report(error);
      if (!(error instanceof ChannelClosed)) await this.read();
    }
  }
}

function merged<Part extends Named>(parts: Part[], name: string, patch: Partial<Part>): Part[] {
  return parts.map((part) => (part.name === name ? { ...part, ...patch } : part));
}
