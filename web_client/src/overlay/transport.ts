// Playback controls of the scene's animation clips; hidden where the scene has none.

import type { AnimationState, Methods } from "heliograph/messages.ts";
import type { RequestArguments } from "heliograph/rpc.ts";
import type { Viewer } from "../session/viewer.ts";
import { button, element, icon, setOptions, setText } from "../widgets/element.ts";
import { requiresControl } from "../widgets/requires_control.ts";

/** The methods whose result is the state of the animation. */
type AnimationMethod = Extract<keyof Methods, `animation.${string}`>;

const refreshMs = 200;
const lockstepRefreshMs = 500;
const scrubSteps = 1000;
const rates = [0.25, 0.5, 1, 2, 4];

export function mountTransport(viewer: Viewer, root: HTMLElement): void {
  let readAt = 0;
  let scrubbing = false;
  const call = async <Name extends AnimationMethod>(
    method: Name,
    ...params: RequestArguments<Methods[Name]["params"]>
  ): Promise<void> => {
    try {
      viewer.shown.takeAnimation(await viewer.rpc.request(method, ...params));
    } catch (error) {
      viewer.report(error);
    }
  };
  const play = button("Play", "play", () => {
    void call(viewer.animation.value?.playing ? "animation.pause" : "animation.play");
  });
  const clip = element("select", {
    name: "clip",
    "aria-label": "Clip",
    change: () => void call("animation.play", { clip: clip.value }),
  });
  const scrub = element("input", {
    type: "range",
    name: "scrub",
    min: "0",
    max: String(scrubSteps),
    step: "1",
    "aria-label": "Time in the clip",
    input: () => {
      scrubbing = true;
      seek();
    },
    change: () => (scrubbing = false),
  });
  const rate = element(
    "select",
    {
      name: "rate",
      "aria-label": "Speed",
      change: () => void call("animation.rate", { rate: Number(rate.value) }),
    },
    ...rates.map((value) => element("option", { value: String(value) }, `${value}×`)),
  );
  const time = element("span", { class: "time" });
  root.append(requiresControl(viewer, play, clip, scrub, time, rate));

  const duration = (state: AnimationState): number => {
    const name = state.clip ?? clip.value;
    return state.clips.find((clip) => clip.name === name)?.duration ?? 0;
  };
  let seeking = false;
  /** One request at a time; the last position of a drag is always sent. */
  const seek = (): void => {
    const state = viewer.animation.value;
    if (!state || seeking) return;
    const position = scrub.value;
    seeking = true;
    const seconds = (Number(position) / scrubSteps) * duration(state);
    const ready = state.clip ? Promise.resolve() : startPaused();
    void ready
      .then(() => call("animation.seek", { seconds }))
      .then(() => {
        seeking = false;
        if (scrubbing && scrub.value !== position) seek();
      });
  };
  const startPaused = async (): Promise<void> => {
    await call("animation.play", { clip: clip.value });
    await call("animation.pause");
  };
  const refresh = (): void => {
    const state = viewer.animation.value;
    if (!state || root.hidden) return;
    const length = duration(state);
    const advances = state.playing && !state.lockstep;
    const elapsed = advances ? ((performance.now() - readAt) / 1000) * state.rate : 0;
    const now = length > 0 ? (state.seconds + elapsed) % length : 0;
    setText(time, `${now.toFixed(1)} / ${length.toFixed(1)} s`);
    if (scrubbing) return;
    const fraction = length > 0 ? now / length : 0;
    scrub.value = String(Math.round(fraction * scrubSteps));
    scrub.style.setProperty("--filled", `${fraction * 100}%`);
  };
  viewer.animation.watch((state) => {
    readAt = performance.now();
    const clips = state?.clips ?? [];
    root.hidden = clips.length === 0;
    document.body.classList.toggle("with-transport", clips.length > 0);
    if (!state || clips.length === 0) return;
    setOptions(
      clip,
      clips.map(({ name }) => ({ value: name, label: name.replaceAll("_", " ") })),
    );
    clip.value = state.clip ?? clips[0]?.name ?? "";
    const nearest = rates.reduce((a, b) =>
      Math.abs(b - state.rate) < Math.abs(a - state.rate) ? b : a,
    );
    rate.value = String(nearest);
    play.replaceChildren(icon(state.playing ? "pause" : "play"));
    play.setAttribute("aria-label", state.playing ? "Pause" : "Play");
    play.dataset.tip = `${state.playing ? "Pause" : "Play"} (space)`;
    refresh();
  });
  setInterval(refresh, refreshMs);
  let refreshPending = false;
  // Steps in lockstep send no notification, only frames.
  viewer.frame.watch(() => {
    const state = viewer.animation.value;
    if (refreshPending || !state?.playing || !state.lockstep) return;
    refreshPending = true;
    setTimeout(() => {
      refreshPending = false;
      if (viewer.hello) void call("animation.list");
    }, lockstepRefreshMs);
  });
  viewer.togglePlay = () => play.click();
}
