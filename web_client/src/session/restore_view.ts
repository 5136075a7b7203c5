// Restores a view state in a session. The order matters: a scene resets camera and clip, a clip may
// animate the camera. Every step is acknowledged.

import type { JsonObject } from "heliograph/json.ts";
import { ErrorCode } from "heliograph/messages.ts";
import { ChannelClosed, RpcError, type RpcPeer, timedOut } from "heliograph/rpc.ts";
import type { ControlGroup } from "heliograph/settings_schema.ts";
import { type FileError, describeLoadError } from "./file_errors.ts";
import { changesTowards } from "./edits/textures.ts";
import { type Edits, patchesTowards } from "./scene_edits.ts";
import { type ViewState, patchTowards, withoutPath } from "./view_state.ts";

const retryMs = 300;
const loadTimeoutMs = 600_000;
const maxRejectedSettings = 12;

export interface RestoreHost {
  rpc: RpcPeer;
  schema(): ControlGroup;
  /** Whether the server has this method. */
  supports(method: string): boolean;
  /** False once a newer state is pending or the connection has changed. */
  isCurrent(): boolean;
  /** Whether the session was created for this state, so that no other client loads a scene. */
  ownsSession(): boolean;
  /** Reports a part that could not be restored. */
  reportSkipped(sentence: string): void;
  /** Reports that the scene could not be loaded. */
  reportFile(error: FileError): void;
}

/** Resolves to true when every part is acknowledged, to false when the state is not current. */
export async function restoreView(host: RestoreHost, state: ViewState): Promise<boolean> {
  const run = async (steps: Step[]): Promise<boolean> => {
    for (const step of steps) {
      if (!(await retryWhileBusy(host, () => step(host, state)))) return false;
    }
    return host.isCurrent();
  };
  if (!(await run([restoreScene, restoreSettings]))) return false;
  if (host.ownsSession() && !(await hasScene(host))) return host.isCurrent();
  return run([
    restoreEnvironment,
    restoreTextures,
    restoreLights,
    restoreMaterials,
    restoreNodes,
    restoreSection,
    restoreClip,
    restoreCamera,
  ]);
}

type Step = (host: RestoreHost, state: ViewState) => Promise<void>;

/** In a session of the page's own no other client loads a scene where this state has failed to. */
async function hasScene({ rpc }: RestoreHost): Promise<boolean> {
  return rpc.request("scene.info").then(
    () => true,
    (error: unknown) => !(error instanceof RpcError && error.code === ErrorCode.notReady),
  );
}

/** Repeats a step while the server is busy or not ready, until the connection is lost. */
async function retryWhileBusy(host: RestoreHost, step: () => Promise<void>): Promise<boolean> {
  while (host.isCurrent()) {
    try {
      await step();
      return true;
    } catch (error) {
      if (error instanceof ChannelClosed) return false;
      if (!isTransient(error)) {
        host.reportSkipped(error instanceof RpcError ? error.sentence : (error as Error).message);
        return true;
      }
      await new Promise((resolve) => setTimeout(resolve, retryMs));
    }
  }
  return false;
}

/** Errors that a retry can resolve: no scene yet, rate limit, timeout. */
function isTransient(error: unknown): boolean {
  const transient: number[] = [ErrorCode.notReady, ErrorCode.rateLimited, timedOut];
  return error instanceof RpcError && transient.includes(error.code);
}

/** Waits for the server's initial scene first: loading another one would cancel it. */
async function restoreScene(
  { rpc, ownsSession, reportFile }: RestoreHost,
  state: ViewState,
): Promise<void> {
  const info = await rpc.request("scene.info").catch((error: unknown) => {
    if (!ownsSession() || state.scene === undefined || !isTransient(error)) throw error;
    return null;
  });
  const matches = <Value>(expected: Value | undefined, actual: Value | undefined): boolean =>
    expected === undefined || expected === actual;
  const { scene, part, variant } = state;
  const loaded = info && matches(scene, info.name) && matches(part, info.scene);
  if (loaded && matches(variant, info.variant)) return;
  const index = part === undefined ? undefined : String(part);
  const name = scene ?? info?.name;
  if (name === undefined) return;
  const load = { name, scene: index, variant };
  try {
    await rpc.request("scene.load", load, loadTimeoutMs);
  } catch (error) {
    if (error instanceof ChannelClosed || isTransient(error)) throw error;
    const cancelled = error instanceof RpcError && error.code === ErrorCode.conflict;
    if (!cancelled) reportFile(describeLoadError(name, error));
  }
}

/** Settings that this server rejects are left out; all others are restored. */
async function restoreSettings(host: RestoreHost, { settings }: ViewState): Promise<void> {
  if (!settings) return;
  const state = await host.rpc.request("settings.get");
  let patch = patchTowards(host.schema(), state.settings, settings);
  for (let rejected = 0; patch && rejected < maxRejectedSettings; rejected += 1) {
    try {
      await host.rpc.request("settings.patch", { patch });
      return;
    } catch (error) {
      const path = error instanceof RpcError ? error.data.path : undefined;
      if (!path || isTransient(error)) throw error;
      const smaller: JsonObject = withoutPath(patch, path);
      patch = Object.keys(smaller).length > 0 ? smaller : null;
      host.reportSkipped(`The server rejects the previous value of ${path}`);
    }
  }
}

async function restoreEnvironment(host: RestoreHost, { environment }: ViewState): Promise<void> {
  if (environment === undefined || !host.supports("environment.set")) return;
  const { current } = await host.rpc.request("environment.list");
  if (current !== environment) await host.rpc.request("environment.set", { name: environment });
}

/** The scene is loaded again once for all that are set at the same time. */
async function restoreTextures(host: RestoreHost, { textures }: ViewState): Promise<void> {
  if (!textures || !host.supports("textures.set")) return;
  const { textures: current } = await host.rpc.request("textures.list", {});
  const changes = changesTowards(current, textures);
  const answers = await Promise.allSettled(
    changes.map((change) => host.rpc.request("textures.set", change, loadTimeoutMs)),
  );
  const failures = answers.map((answer): unknown =>
    answer.status === "rejected" ? answer.reason : null,
  );
  const stops = (error: unknown): boolean => !(error instanceof RpcError) || isTransient(error);
  const stopping: unknown = failures.find((error) => error !== null && stops(error));
  if (stopping) throw stopping;
  changes.forEach(({ material, slot }, index) => {
    if (failures[index]) {
      host.reportSkipped(`The server rejects the previous ${slot} texture of ${material}`);
    }
  });
}

async function restoreLights(host: RestoreHost, { lights }: ViewState): Promise<void> {
  if (!lights || !host.supports("lights.patch")) return;
  const { lights: current } = await host.rpc.request("lights.list");
  await restoreParts(host, patchesTowards(current, lights), (light, patch) =>
    host.rpc.request("lights.patch", { light, patch }),
  );
}

async function restoreMaterials(host: RestoreHost, { materials }: ViewState): Promise<void> {
  if (!materials || !host.supports("materials.patch")) return;
  const { materials: current } = await host.rpc.request("materials.list");
  await restoreParts(host, patchesTowards(current, materials), (material, patch) =>
    host.rpc.request("materials.patch", { material, patch }),
  );
}

async function restoreNodes({ rpc, supports }: RestoreHost, { nodes }: ViewState): Promise<void> {
  if (!nodes || !supports("nodes.patch")) return;
  const { hidden, isolated, selected } = nodes;
  if (hidden.length > 0) await rpc.request("nodes.patch", { nodes: hidden, patch: { visible: false } });
  if (isolated.length > 0) await rpc.request("nodes.isolate", { nodes: isolated });
  if (selected.length > 0) await rpc.request("selection.set", { nodes: selected });
}

async function restoreSection(host: RestoreHost, { section }: ViewState): Promise<void> {
  if (section && host.supports("section.set")) await host.rpc.request("section.set", section);
}

/** A light or material that the server rejects does not stop the others. */
async function restoreParts(
  host: RestoreHost,
  patches: Edits,
  send: (name: string, patch: JsonObject) => Promise<unknown>,
): Promise<void> {
  for (const [name, patch] of Object.entries(patches)) {
    try {
      await send(name, patch);
    } catch (error) {
      if (!(error instanceof RpcError) || isTransient(error)) throw error;
      host.reportSkipped(`The server rejects the previous state of ${name}`);
    }
  }
}

async function restoreClip({ rpc }: RestoreHost, { clip }: ViewState): Promise<void> {
  if (clip === undefined) return;
  const current = await rpc.request("animation.list");
  if (clip === null) {
    if (current.playing) await rpc.request("animation.pause");
    return;
  }
  if (!current.clips.some(({ name }) => name === clip.clip)) return;
  await rpc.request("animation.play", { clip: clip.clip, rate: clip.rate });
  await rpc.request("animation.seek", { seconds: clip.seconds });
  if (!clip.playing) await rpc.request("animation.pause");
}

async function restoreCamera({ rpc }: RestoreHost, { camera }: ViewState): Promise<void> {
  if (!camera) return;
  const { eye, target, up, vertical_fov, name } = camera;
  const info = await rpc.request("scene.info");
  const named = name !== null && info.cameras.includes(name);
  await rpc.request("camera.set", named ? { name } : { eye, target, up, vertical_fov });
}
