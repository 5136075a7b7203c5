// How fast it runs: the figures a person asks for first, then where a frame's time goes.

import type { FrameStats } from "../protocol/messages.ts";
import type { Viewer } from "../viewer.ts";
import { element, setText } from "./element.ts";
import { PassTable, type TimedPass } from "./pass_timings.ts";

const refreshMs = 250;
const restingAfterMs = 1200;

export function createPerformanceSection(viewer: Viewer): HTMLElement {
  const rate = figure("Frame rate", "Pictures drawn per second. At rest nothing is sent.");
  const latency = figure("Latency", "From moving the camera to drawing the picture that shows it.");
  const bandwidth = figure("Bandwidth", "What the stream needs right now.");
  const size = figure("Picture", "Pixels the server renders and sends.");
  const samples = figure("Samples", "Samples per pixel gathered while the view rests.");
  const frameTime = figure("Frame", "Time the server spends on one frame.");
  const table = new PassTable();
  const device = element("p", { class: "facts device" });
  const refresh = (): void => {
    const now = performance.timeOrigin + performance.now();
    const frame = viewer.frame.value;
    const resting = !frame || now - frame.drawnAt > restingAfterMs;
    const { fps, bytesPerSecond } = viewer.rates.read(now);
    const median = viewer.latency.median;
    setText(rate.value, resting ? (frame ? "at rest" : "–") : `${formatRate(fps)} fps`);
    setText(latency.value, median === null ? "–" : `${median.toFixed(0)} ms`);
    const bytes = formatBandwidth(resting ? 0 : bytesPerSecond);
    setText(bandwidth.value, frame ? bytes : "–");
    setText(size.value, frame ? `${frame.width} × ${frame.height}` : "–");
    setText(samples.value, frame ? String(frame.samples) : "–");
  };
  setInterval(refresh, refreshMs);
  refresh();
  viewer.stats.watch((stats) => {
    if (!stats) return;
    setText(frameTime.value, `${formatMs(stats.frame_ms)} ms`);
    table.show(timedPasses(stats));
  });
  viewer.connection.state.watch((state) => {
    if (state.kind === "live") {
      setText(device, `${state.hello.device.name} · ${state.hello.tracer} rays`);
    }
  });
  const figures = element("dl", { class: "figures" });
  for (const { node } of [rate, latency, frameTime, bandwidth, size, samples]) figures.append(node);
  return element("div", { class: "section-body" }, figures, table.node, device);
}

/** The passes of a frame, and the encoder, which works beside them. */
function timedPasses(stats: FrameStats): TimedPass[] {
  return [...stats.passes, { name: "encode", kind: "host", ms: stats.encode_ms }];
}

function figure(label: string, help: string): { node: HTMLElement; value: HTMLElement } {
  const value = element("dd", {}, "–");
  const node = element(
    "div",
    { class: "figure", "data-tip": help, "data-figure": label.toLowerCase().replace(" ", "_") },
    element("dt", {}, label),
    value,
  );
  return { node, value };
}

export function formatRate(fps: number): string {
  return fps < 9.95 ? fps.toFixed(1) : fps.toFixed(0);
}

export function formatMs(ms: number): string {
  return ms < 9.95 ? ms.toFixed(1) : ms.toFixed(0);
}

export function formatBandwidth(bytesPerSecond: number): string {
  return bytesPerSecond < 999_500
    ? `${(bytesPerSecond / 1e3).toFixed(0)} kB/s`
    : `${(bytesPerSecond / 1e6).toFixed(1)} MB/s`;
}
