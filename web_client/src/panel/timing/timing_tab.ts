// The Timing tab: key figures, time per pass, and the stream's settings.

import type { Viewer } from "../../session/viewer.ts";
import { element, setText } from "../../widgets/element.ts";
import { createSection } from "../../widgets/section.ts";
import { PassTable } from "./pass_table.ts";
import { type Stage, stagesOf } from "./stage_times.ts";
import { TimeChart } from "./time_chart.ts";

const refreshMs = 250;
const idleAfterMs = 1200;

export function createTimingTab(viewer: Viewer, streamFields: HTMLElement): HTMLElement {
  const rate = figure("Frame rate", "Frames drawn per second. A converged view sends no frames.");
  const shown = figure(
    "View rate",
    "Images shown per second: frames, and the last frame as seen from the camera since.",
  );
  const latency = figure(
    "Latency",
    "From moving the camera to drawing the first frame of the server that shows it.",
  );
  const response = figure(
    "Response",
    "From moving the camera to drawing the first image that shows it: often the last frame as " +
      "seen from the new camera.",
  );
  const bandwidth = figure("Bandwidth", "Data rate of the stream.");
  const size = figure("Frame size", "Pixels that the server renders and sends.");
  const samples = figure("Samples", "Samples per pixel, accumulated while the view is static.");
  const frameTime = figure("Frame time", "Time that the server spends on one frame.");
  const quality = figure("Quality", "JPEG quality, 1 to 100.");
  const scale = figure("Scale", "Sent pixels per screen pixel, in each direction.");
  const decode = figure("Decoding", "Time that this browser needs to decode and draw a frame.");
  let newest: Stage[] = [];
  const chart = new TimeChart((sample) => table.show(sample ?? newest, sample !== null));
  const table = new PassTable((stage) => chart.hueOf(stage));
  const device = element("p", { class: "facts device" });
  const refresh = (): void => {
    const now = performance.timeOrigin + performance.now();
    const frame = viewer.frame.value;
    const idle = !frame || now - frame.drawnAt > idleAfterMs;
    const idleText = frame?.final ? "converged" : "refining";
    const { fps, bytesPerSecond } = viewer.meters.rates.read(now);
    const median = viewer.meters.latency.median;
    setText(rate.value, idle ? (frame ? idleText : "–") : `${formatRate(fps)} fps`);
    setText(latency.value, median === null ? "–" : `${median.toFixed(0)} ms`);
    const first = viewer.meters.responses.median;
    setText(response.value, first === null ? "–" : `${first.toFixed(0)} ms`);
    const shownFps = viewer.meters.shownRates.read(now).fps;
    setText(shown.value, shownFps > 0 ? `${formatRate(shownFps)} fps` : "–");
    const bytes = formatBandwidth(idle ? 0 : bytesPerSecond);
    setText(bandwidth.value, frame ? bytes : "–");
    setText(size.value, frame ? `${frame.width} × ${frame.height}` : "–");
    setText(samples.value, frame ? String(frame.samples) : "–");
    setText(quality.value, frame ? String(frame.quality) : "–");
    setText(scale.value, frame ? `${Math.round(100 * shownScale(frame))} %` : "–");
    setText(decode.value, frame ? `${frame.decodeMs.toFixed(1)} ms` : "–");
  };
  setInterval(refresh, refreshMs);
  refresh();
  viewer.stats.watch((stats) => {
    if (!stats) return;
    setText(frameTime.value, `${formatMs(stats.frame_ms)} ms`);
    newest = stagesOf(stats);
    chart.add(newest);
    table.show(newest);
  });
  viewer.connection.state.watch((state) => {
    if (state.kind === "live") {
      setText(device, `${state.hello.device.name} · ${state.hello.tracer} rays`);
    }
  });
  const figures = element("dl", { class: "figures" });
  const all = [rate, shown, latency, response, frameTime, bandwidth, size, samples, quality, scale, decode];
  figures.append(...all.map(({ node }) => node));
  const body = element("div", { class: "section-body" }, figures, chart.node, table.node, device);
  return element(
    "div",
    { "data-section": "performance" },
    body,
    createSection({ id: "stream", title: "Stream", body: streamFields, openByDefault: true }),
  );
}

/** Sent pixels per device pixel; the frame covers the view. */
function shownScale({ width, height }: { width: number; height: number }): number {
  return Math.min(width / innerWidth, height / innerHeight) / devicePixelRatio;
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

function formatRate(fps: number): string {
  return fps < 9.95 ? fps.toFixed(1) : fps.toFixed(0);
}

function formatMs(ms: number): string {
  return ms < 9.95 ? ms.toFixed(1) : ms.toFixed(0);
}

function formatBandwidth(bytesPerSecond: number): string {
  return bytesPerSecond < 999_500
    ? `${(bytesPerSecond / 1e3).toFixed(0)} kB/s`
    : `${(bytesPerSecond / 1e6).toFixed(1)} MB/s`;
}
