// One job: its state, progress, what failed, and its files as they come.

import type { JobCreateResultFiles } from "heliograph/messages.ts";
import { element, setText, uniqueId } from "../widgets/element.ts";
import {
  type Job,
  isActive,
  jobTitle,
  previewKind,
  progressText,
  stateLabel,
} from "./job_texts.ts";

/** The first ones: a dataset has thousands. */
const shownFiles = 24;
const shownFailures = 10;

interface JobCardHost {
  mayChange: boolean;
  /** An address of this server. */
  url(path: string): string;
  /** @throws Error with the server's reason */
  files(job: string): Promise<JobCreateResultFiles[]>;
  /** @throws Error with the server's reason */
  cancel(job: string): Promise<void>;
}

export class JobCard {
  readonly node: HTMLElement;
  private job: Job;
  private readonly host: JobCardHost;
  private readonly state = element("span", { class: "state" });
  private readonly progress = element("progress", { "aria-label": "Images rendered" });
  private readonly text = element("p", { class: "figures" });
  private readonly cancel: HTMLButtonElement;
  private readonly archive: HTMLAnchorElement;
  private readonly failures = element("ul", { class: "failures", hidden: true });
  private readonly files = element("ul", { class: "files", hidden: true });
  private readonly more = element("p", { class: "figures", hidden: true });
  private readonly error = element("p", { class: "error", role: "alert", hidden: true });
  private readonly shown = new Set<string>();
  /** What the files were last read for. */
  private readFor = "";
  private visible = false;

  constructor(job: Job, host: JobCardHost) {
    this.job = job;
    this.host = host;
    const title = jobTitle(job);
    const id = uniqueId("job");
    this.cancel = element(
      "button",
      {
        type: "button",
        class: "button quiet",
        "aria-label": `Cancel ${title}`,
        click: () => void this.stop(),
      },
      "Cancel",
    );
    this.archive = element(
      "a",
      {
        class: "button quiet",
        href: host.url(`api/v1/jobs/${job.job}/results.zip`),
        download: true,
        hidden: true,
        "aria-label": `Download ZIP of ${title}`,
      },
      "Download ZIP",
    );
    this.node = element(
      "article",
      { "aria-labelledby": id, "data-job": job.job },
      element(
        "header",
        {},
        element("h3", { id }, title),
        this.state,
        element("span", { class: "actions" }, this.cancel, this.archive),
      ),
      this.progress,
      this.text,
      this.error,
      this.failures,
      this.files,
      this.more,
    );
    this.update(job);
  }

  update(job: Job): void {
    this.job = job;
    this.node.dataset.state = job.state;
    setText(this.state, stateLabel(job));
    setText(this.text, progressText(job, Date.now() / 1000));
    this.progress.hidden = job.state !== "running";
    this.progress.max = Math.max(1, job.images);
    this.progress.value = job.images_done;
    this.cancel.hidden = !this.host.mayChange || !isActive(job);
    this.showFailures();
    void this.readFiles();
  }

  /** Files are read of jobs in view only. */
  setVisible(visible: boolean): void {
    this.visible = visible;
    void this.readFiles();
  }

  private async stop(): Promise<void> {
    this.cancel.disabled = true;
    this.error.hidden = true;
    try {
      await this.host.cancel(this.job.job);
    } catch (error) {
      this.error.hidden = false;
      setText(this.error, (error as Error).message);
    } finally {
      this.cancel.disabled = false;
    }
  }

  private showFailures(): void {
    const { failures } = this.job;
    this.failures.hidden = failures.length === 0;
    if (this.failures.childElementCount > 0 || failures.length === 0) return;
    const lines = failures.slice(0, shownFailures).map(({ entry, scene, reason }) => {
      const what = entry === 0 ? "" : `Entry ${entry}, ${scene}: `;
      return element("li", {}, `${what}${reason}`);
    });
    const left = failures.length - lines.length;
    this.failures.append(...lines, left > 0 ? element("li", {}, `and ${left} more`) : "");
  }

  private async readFiles(): Promise<void> {
    const { job, state, images_done: done, attempts } = this.job;
    const reason = `${state} ${done} ${attempts}`;
    if (!this.visible || state === "queued" || reason === this.readFor) return;
    this.readFor = reason;
    try {
      this.showFiles(await this.host.files(job));
    } catch {
      // It is asked for again with the next image, or when the job comes into view again.
      this.readFor = "";
    }
  }

  private showFiles(files: JobCreateResultFiles[]): void {
    for (const file of files) {
      if (this.shown.size >= shownFiles || this.shown.has(file.name)) continue;
      this.shown.add(file.name);
      this.files.append(this.thumbnail(file));
    }
    const left = files.length - this.shown.size;
    this.files.hidden = this.shown.size === 0;
    this.archive.hidden = files.length === 0;
    this.more.hidden = left <= 0;
    setText(this.more, `${left} more in the archive`);
  }

  private thumbnail({ name, url }: JobCreateResultFiles): HTMLElement {
    const href = this.host.url(url.slice(1));
    const link = element("a", { href, target: "_blank" }, name);
    const kind = previewKind(name);
    if (kind === "video") {
      const video = { src: href, controls: true, preload: "metadata", "aria-label": name };
      return element("li", {}, element("video", video), link);
    }
    if (kind === "none") return element("li", {}, link);
    const image = element("img", { src: href, alt: "", loading: "lazy", decoding: "async" });
    link.prepend(image);
    return element("li", {}, link);
  }
}
