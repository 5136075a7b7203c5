// What the page of jobs says in words.

import type { JobCreateResult, JobListResult } from "heliograph/messages.ts";

export type Job = JobCreateResult;

export const isActive = ({ state }: Job): boolean => state === "queued" || state === "running";

const stateLabels: Record<Job["state"], string> = {
  queued: "Waiting",
  running: "Running",
  done: "Done",
  partial: "Partly failed",
  failed: "Failed",
  canceled: "Canceled",
};

export const stateLabel = ({ state }: Job): string => stateLabels[state];

export const jobTitle = ({ name, job }: Job): string => name ?? `Job ${job.slice(0, 8)}`;

/** 48210 -> "48 kB" */
function size(bytes: number): string {
  const units = ["kB", "MB", "GB", "TB"];
  let value = bytes / 1000;
  let unit = 0;
  while (value >= 999.5 && unit < units.length - 1) [value, unit] = [value / 1000, unit + 1];
  const digits = value < 9.95 && value > 0 ? 1 : 0;
  return `${value.toFixed(digits)} ${units[unit]}`;
}

/** 75 -> "1 min 15 s" */
export function duration(seconds: number): string {
  const whole = Math.max(0, Math.round(seconds));
  if (whole < 60) return `${whole} s`;
  const minutes = Math.floor(whole / 60);
  if (minutes < 60) return `${minutes} min ${whole % 60} s`;
  const hours = Math.floor(minutes / 60);
  return hours < 48 ? `${hours} h ${minutes % 60} min` : `${Math.floor(hours / 24)} days`;
}

const counted = (count: number, what: string): string =>
  `${count} ${count === 1 ? what : `${what}s`}`;

/** One line on how far a job is; `now` in seconds since 1970. */
export function progressText(job: Job, now: number): string {
  const { state, images, images_done: done, started, ended, expires } = job;
  if (state === "queued") {
    const before = job.attempts > 0 ? ", to be begun again" : "";
    const first = job.priority === 0 ? "" : `, priority ${job.priority}`;
    return `${counted(images, "image")}${first}${before}`;
  }
  if (state === "running") {
    const left = started === null || done === 0 ? null : ((now - started) / done) * (images - done);
    const remaining = left === null ? "" : `, about ${duration(left)} left`;
    return `${done} of ${counted(images, "image")}${remaining}`;
  }
  const took = started === null || ended === null ? "" : ` in ${duration(ended - started)}`;
  const kept = expires === null ? "" : `, kept for ${duration(expires - now)}`;
  return `${counted(done, "image")}${took}${kept}`;
}

/** One line on all jobs. */
export function summaryText({ queued, bytes, quota }: JobListResult, running: number): string {
  const jobs = running > 0 ? `${running} running, ${queued} waiting` : `${queued} waiting`;
  return `${jobs} · ${size(bytes)} of ${size(quota)} used`;
}

/** What a browser shows of a file. */
export function previewKind(name: string): "image" | "video" | "none" {
  const extension = name.slice(name.lastIndexOf(".") + 1).toLowerCase();
  if (["png", "jpg", "webp"].includes(extension)) return "image";
  return ["mp4", "webm"].includes(extension) ? "video" : "none";
}
