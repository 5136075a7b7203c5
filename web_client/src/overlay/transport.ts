// Play, pause, scrub and rate of the scene's clips; there only when the scene has any.

import type { AnimationState } from "heliograph/messages.ts";
import { requiresControl } from "../widgets/requires_control.ts";
import { button, element, icon, setOptions, setText } from "../widgets/element.ts";
import type { Viewer } from "../session/viewer.ts";

const refreshMs = 200;
const stepsMs = 500;
const scrubSteps = 1000;
const rates = [0.25, 0.5, 1, 2, 4];

export function mountTransport(viewer: Viewer, root: HTMLElement): void {
  let readAt = 0;
  let scrubbing = false;
  const ask = async (method: string, params: object = {}): Promise<void> => {
    try {
      viewer.onAnimationState(await viewer.rpc.request<AnimationState>(method, params));
    } catch (error) {
      viewer.report(error);
    }
  };
  const play = button("Play", "play", () => {
    void ask(viewer.animation.value?.playing ? "animation.pause" : "animation.play");
  });
  const clip = element("select", {
    name: "clip",
    "aria-label": "Clip",
    change: () => void ask("animation.play", { clip: clip.value }),
  });
  const scrub = element("input", {
    type: "range",
    name: "scrub",
    min: "0",
    max: String(scrubSteps),
    step: "1",
    "aria-label": "Moment of the clip",
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
      change: () => void ask("animation.rate", { rate: Number(rate.value) }),
    },
    ...rates.map((value) => element("option", { value: String(value) }, `${value}×`)),
  );
  const time = element("span", { class: "time" });
  root.append(requiresControl(viewer, play, clip, scrub, time, rate));

  const duration = (state: AnimationState): number => {
    const name = state.clip ?? clip.value;
    return state.clips.find((one) => one.name === name)?.duration ?? 0;
  };
  let seekUnderWay = false;
  /** One request at a time; the last place of a drag is always sent. */
  const seek = (): void => {
    const state = viewer.animation.value;
    if (!state || seekUnderWay) return;
    const place = scrub.value;
    seekUnderWay = true;
    const seconds = (Number(place) / scrubSteps) * duration(state);
    const chosen = state.clip ? Promise.resolve() : startPaused();
    void chosen
      .then(() => ask("animation.seek", { seconds }))
      .then(() => {
        seekUnderWay = false;
        if (scrubbing && scrub.value !== place) seek();
      });
  };
  const startPaused = async (): Promise<void> => {
    await ask("animation.play", { clip: clip.value });
    await ask("animation.pause");
  };
  const refresh = (): void => {
    const state = viewer.animation.value;
    if (!state || root.hidden) return;
    const length = duration(state);
    const passes = state.playing && !state.lockstep;
    const passed = passes ? ((performance.now() - readAt) / 1000) * state.rate : 0;
    const now = length > 0 ? (state.seconds + passed) % length : 0;
    setText(time, `${now.toFixed(1)} / ${length.toFixed(1)} s`);
    if (scrubbing) return;
    const part = length > 0 ? now / length : 0;
    scrub.value = String(Math.round(part * scrubSteps));
    scrub.style.setProperty("--filled", `${part * 100}%`);
  };
  viewer.animation.watch((state) => {
    readAt = performance.now();
    const clips = state?.clips ?? [];
    root.hidden = clips.length === 0;
    document.body.classList.toggle("with-transport", clips.length > 0);
    if (!state || clips.length === 0) return;
    setOptions(clip, clips.map(({ name }) => ({ value: name, label: name.replaceAll("_", " ") })));
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
  let stepAsked = false;
  // Single steps of lockstep are not told: they show in pictures.
  viewer.frame.watch(() => {
    const state = viewer.animation.value;
    if (stepAsked || !state?.playing || !state.lockstep) return;
    stepAsked = true;
    setTimeout(() => {
      stepAsked = false;
      if (viewer.hello) void ask("animation.list");
    }, stepsMs);
  });
  viewer.togglePlay = () => play.click();
}
