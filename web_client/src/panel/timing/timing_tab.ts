// How fast it runs: the figures a person asks for first, then where a frame's time goes.

import type { Viewer } from "../../session/viewer.ts";
import { element, setText } from "../../widgets/element.ts";
import { createSection } from "../../widgets/section.ts";
import { PassTable } from "./pass_table.ts";
import { type Stage, stagesOf } from "./stage_times.ts";
import { TimeChart } from "./time_chart.ts";

const refreshMs = 250;
const restingAfterMs = 1200;

export function createStatsTab(viewer: Viewer, streamFields: HTMLElement): HTMLElement {
  const rate = figure("Frame rate", "Pictures drawn per second. At rest nothing is sent.");
  const latency = figure("Latency", "From moving the camera to drawing the picture that shows it.");
  const bandwidth = figure("Bandwidth", "What the stream needs right now.");
  const size = figure("Picture", "Pixels the server renders and sends.");
  const samples = figure("Samples", "Samples per pixel gathered while the view rests.");
  const frameTime = figure("Frame", "Time the server spends on one frame.");
  const quality = figure("Quality", "Of the JPEG pictures, out of 100.");
  const scale = figure("Scale", "Pixels sent for each pixel of the screen, in each direction.");
  const decode = figure("Decoding", "Time this browser takes to decode and draw a picture.");
  let newest: Stage[] = [];
  const chart = new TimeChart((moment) => table.show(moment ?? newest, moment !== null));
  const table = new PassTable((stage) => chart.hueOf(stage));
  const device = element("p", { class: "facts device" });
  const refresh = (): void => {
    const now = performance.timeOrigin + performance.now();
    const frame = viewer.frame.value;
    const resting = !frame || now - frame.drawnAt > restingAfterMs;
    const rest = frame?.final ? "at rest" : "refining";
    const { fps, bytesPerSecond } = viewer.rates.read(now);
    const median = viewer.latency.median;
    setText(rate.value, resting ? (frame ? rest : "–") : `${formatRate(fps)} fps`);
    setText(latency.value, median === null ? "–" : `${median.toFixed(0)} ms`);
    const bytes = formatBandwidth(resting ? 0 : bytesPerSecond);
    setText(bandwidth.value, frame ? bytes : "–");
    setText(size.value, frame ? `${frame.width} × ${frame.height}` : "–");
    setText(samples.value, frame ? String(frame.samples) : "–");
    setText(quality.value, frame ? String(frame.quality) : "–");
    setText(scale.value, frame ? `${Math.round(100 * shownScale(frame.width))} %` : "–");
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
  const all = [rate, latency, frameTime, bandwidth, size, samples, quality, scale, decode];
  figures.append(...all.map(({ node }) => node));
  const body = element("div", { class: "section-body" }, figures, chart.node, table.node, device);
  return element(
    "div",
    { "data-section": "performance" },
    body,
    createSection({ id: "stream", title: "Stream", body: streamFields, openAtFirst: true }),
  );
}

/** Sent pixels per device pixel, along the width of the view. */
function shownScale(width: number): number {
  return width / Math.max(1, innerWidth * devicePixelRatio);
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
