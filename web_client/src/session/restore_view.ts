// Puts a view state back onto a server, in the order in which each part keeps the ones before it:
// a scene resets camera and clip, a clip may carry the camera. Every step is acknowledged.

import {
  type AnimationState,
  type Camera,
  type EnvironmentState,
  type JsonObject,
  type SceneInfo,
  ErrorCode,
} from "heliograph/messages.ts";
import { ChannelClosed, RpcError, type RpcPeer } from "heliograph/rpc.ts";
import type { ControlGroup } from "heliograph/settings_schema.ts";
import { type Edits, type Part, patchesTowards } from "./scene_edits.ts";
import { type ViewState, patchTowards, withoutPath } from "./view_state.ts";

const retryMs = 300;
const loadTimeoutMs = 600_000;
const mostRefusals = 12;

export interface RestoreHost {
  rpc: RpcPeer;
  schema(): ControlGroup;
  /** Whether the server has this method. */
  capabilities(method: string): boolean;
  /** Whether this state is still wanted: not after a newer wish or on a newer connection. */
  wanted(): boolean;
  /** Whether the session was made for this state, so that nothing is loaded there by others. */
  isOwn(): boolean;
  /** Tells what could not be put back. */
  lost(sentence: string): void;
}

/** Resolves with true when every part is acknowledged, false when it is no longer wanted. */
export async function restore(host: RestoreHost, state: ViewState): Promise<boolean> {
  const steps = [
    restoreScene,
    restoreSettings,
    restoreEnvironment,
    restoreLights,
    restoreMaterials,
    restoreClip,
    restoreCamera,
  ];
  for (const step of steps) {
    if (!(await insist(host, () => step(host, state)))) return false;
  }
  return host.wanted();
}

/** Repeats a step while the server is busy or not ready; gives up only with the connection. */
async function insist(host: RestoreHost, step: () => Promise<void>): Promise<boolean> {
  while (host.wanted()) {
    try {
      await step();
      return true;
    } catch (error) {
      if (error instanceof ChannelClosed) return false;
      if (!isPassing(error)) {
        host.lost(error instanceof RpcError ? error.sentence : (error as Error).message);
        return true;
      }
      await new Promise((resolve) => setTimeout(resolve, retryMs));
    }
  }
  return false;
}

/** Errors that go away by themselves: no scene yet, too many calls, no answer in time. */
function isPassing(error: unknown): boolean {
  const passing: number[] = [ErrorCode.notReady, ErrorCode.tooManyCalls, ErrorCode.timedOut];
  return error instanceof RpcError && passing.includes(error.code);
}

/** Also waits for the scene that the server starts with: loading another meanwhile would end it. */
async function restoreScene({ rpc, isOwn }: RestoreHost, state: ViewState): Promise<void> {
  const info = await rpc.request<SceneInfo>("scene.info").catch((error: unknown) => {
    if (!isOwn() || state.scene === undefined || !isPassing(error)) throw error;
    return null;
  });
  const same = <Value>(wanted: Value | undefined, there: Value | undefined): boolean =>
    wanted === undefined || wanted === there;
  const { scene, part, variant } = state;
  const there = info && same(scene, info.name) && same(part, info.scene);
  if (there && same(variant, info.variant)) return;
  const chosen = part === undefined ? undefined : String(part);
  const load = { name: scene ?? info?.name, scene: chosen, variant };
  await rpc.request("scene.load", load, loadTimeoutMs);
}

/** What this server does not know or accept is left out; the rest is put back all the same. */
async function restoreSettings(host: RestoreHost, { settings }: ViewState): Promise<void> {
  if (!settings) return;
  const state = await host.rpc.request<{ settings: JsonObject }>("settings.get");
  let patch = patchTowards(host.schema(), state.settings, settings);
  for (let refused = 0; patch && refused < mostRefusals; refused += 1) {
    try {
      await host.rpc.request("settings.patch", { patch });
      return;
    } catch (error) {
      const path = error instanceof RpcError ? error.data.path : undefined;
      if (!path || isPassing(error)) throw error;
      const smaller: JsonObject = withoutPath(patch, path);
      patch = Object.keys(smaller).length > 0 ? smaller : null;
      host.lost(`The server does not take ${path} as it was`);
    }
  }
}

async function restoreEnvironment(host: RestoreHost, { environment }: ViewState): Promise<void> {
  if (environment === undefined || !host.capabilities("environment.set")) return;
  const { current } = await host.rpc.request<EnvironmentState>("environment.list");
  if (current !== environment) await host.rpc.request("environment.set", { name: environment });
}

async function restoreLights(host: RestoreHost, { lights }: ViewState): Promise<void> {
  if (!lights || !host.capabilities("lights.patch")) return;
  const there = await host.rpc.request<{ lights: Part[] }>("lights.list");
  await restoreParts(host, patchesTowards(there.lights, lights), (light, patch) =>
    host.rpc.request("lights.patch", { light, patch }),
  );
}

async function restoreMaterials(host: RestoreHost, { materials }: ViewState): Promise<void> {
  if (!materials || !host.capabilities("materials.patch")) return;
  const there = await host.rpc.request<{ materials: Part[] }>("materials.list");
  await restoreParts(host, patchesTowards(there.materials, materials), (material, patch) =>
    host.rpc.request("materials.patch", { material, patch }),
  );
}

/** What the server does not take of one light or material leaves the others in place. */
async function restoreParts(
  host: RestoreHost,
  patches: Edits,
  send: (name: string, patch: JsonObject) => Promise<unknown>,
): Promise<void> {
  for (const [name, patch] of Object.entries(patches)) {
    try {
      await send(name, patch);
    } catch (error) {
      if (!(error instanceof RpcError) || isPassing(error)) throw error;
      host.lost(`The server does not take ${name} as it was`);
    }
  }
}

async function restoreClip({ rpc }: RestoreHost, { clip }: ViewState): Promise<void> {
  if (clip === undefined) return;
  const there = await rpc.request<AnimationState>("animation.list");
  if (clip === null) {
    if (there.playing) await rpc.request("animation.pause");
    return;
  }
  if (!there.clips.some(({ name }) => name === clip.clip)) return;
  await rpc.request("animation.play", { clip: clip.clip, rate: clip.rate });
  await rpc.request("animation.seek", { seconds: clip.seconds });
  if (!clip.playing) await rpc.request("animation.pause");
}

async function restoreCamera({ rpc }: RestoreHost, { camera }: ViewState): Promise<void> {
  if (!camera) return;
  const { eye, target, up, vertical_fov, name } = camera;
  const there = await rpc.request<SceneInfo>("scene.info");
  const named = name !== null && there.cameras.includes(name);
  await rpc.request<Camera>("camera.set", named ? { name } : { eye, target, up, vertical_fov });
}
