// Entry point of the page at /jobs: what waits, runs and has ended, read again while it is shown.

import { ErrorCode } from "heliograph/messages.ts";
import { RpcError } from "heliograph/rpc.ts";
import { SessionAddress } from "../stream/session_address.ts";
import { element, setText } from "../widgets/element.ts";
import { JobCard } from "./job_card.ts";
import { JobList } from "./job_list.ts";
import { type Job, summaryText } from "./job_texts.ts";

const activeIntervalMs = 1000;
const idleIntervalMs = 5000;
/** Ended jobs are read again when an active one has ended, and every so many times. */
const readingsUntilEnded = 10;
const shownWaiting = 100;
const shownEnded = 50;
const endedStates = ["done", "partial", "failed", "canceled"] as const;

function find(id: string): HTMLElement {
  const node = document.getElementById(id);
  if (!node) throw new Error(`The page lacks #${id}`);
  return node;
}

class JobsPage {
  private readonly address = SessionAddress.ofPage(document.baseURI);
  private readonly running = new JobList("Running");
  private readonly waiting = new JobList("Waiting");
  private readonly ended = new JobList("Ended");
  private readonly message = element("p", { class: "message", hidden: true });
  private readonly cards = new Map<string, JobCard>();
  private readonly inView = new IntersectionObserver((changes) => {
    for (const { target, isIntersecting } of changes) {
      this.cards.get((target as HTMLElement).dataset.job ?? "")?.setVisible(isIntersecting);
    }
  });
  private mayChange = false;
  private active: Job[] = [];
  private endedJobs: Job[] = [];
  private readings = 0;
  private timer = 0;

  async start(): Promise<void> {
    const { running, waiting, ended, message } = this;
    find("content").append(message, running.node, waiting.node, ended.node);
    this.mayChange = (await this.address.fetchHello())?.role === "control";
    document.addEventListener("visibilitychange", () => {
      if (!document.hidden) void this.read();
    });
    await this.read();
  }

  /** Reads the jobs, and plans to do so again. */
  private async read(): Promise<void> {
    clearTimeout(this.timer);
    let interval = idleIntervalMs;
    try {
      await this.readJobs();
      if (this.active.length > 0) interval = activeIntervalMs;
    } catch (error) {
      if (error instanceof RpcError && error.code === ErrorCode.notReady) {
        return this.explain("This server renders no jobs: it was started without --jobs.");
      }
      this.explain(`The server does not answer: ${(error as Error).message}`);
    }
    clearTimeout(this.timer);
    if (!document.hidden) this.timer = window.setTimeout(() => void this.read(), interval);
  }

  private async readJobs(): Promise<void> {
    const list = (state: Job["state"], limit: number) =>
      this.address.call("job.list", { state, limit });
    const [running, queued] = await Promise.all([
      list("running", shownWaiting),
      list("queued", shownWaiting),
    ]);
    const active = [...running.jobs, ...queued.jobs];
    const ids = new Set(active.map(({ job }) => job));
    const someEnded = this.active.some(({ job }) => !ids.has(job));
    if (someEnded || this.readings % readingsUntilEnded === 0) {
      const lists = await Promise.all(endedStates.map((state) => list(state, shownEnded)));
      const jobs = lists.flatMap(({ jobs }) => jobs).filter(({ job }) => !ids.has(job));
      jobs.sort((a, b) => (b.ended ?? 0) - (a.ended ?? 0));
      this.endedJobs = jobs.slice(0, shownEnded);
    }
    this.readings += 1;
    this.active = active;
    // As they will be begun: the server lists the newest first.
    const order = queued.jobs.sort((a, b) => b.priority - a.priority || a.created - b.created);
    this.running.show(this.cardsOf(running.jobs), running.jobs.length);
    this.waiting.show(this.cardsOf(order), queued.queued);
    this.ended.show(this.cardsOf(this.endedJobs), this.endedJobs.length);
    this.forgetOthers();
    setText(find("summary"), summaryText(queued, running.jobs.length));
    this.message.hidden = this.cards.size > 0;
    if (this.cards.size === 0) {
      this.explain(
        "There are no jobs. In the viewer, “Render this view” in the menu “Save and share” " +
          "creates one; programs use POST /api/v1/jobs.",
      );
    }
  }

  private cardsOf(jobs: Job[]): JobCard[] {
    return jobs.map((job) => {
      const known = this.cards.get(job.job);
      if (known) {
        known.update(job);
        return known;
      }
      const card = new JobCard(job, {
        mayChange: this.mayChange,
        url: (path) => this.address.url(path).href,
        files: async (id) => (await this.address.call("job.status", { job: id })).files,
        cancel: async (id) => {
          await this.address.call("job.cancel", { job: id });
          await this.read();
        },
      });
      this.cards.set(job.job, card);
      this.inView.observe(card.node);
      return card;
    });
  }

  private forgetOthers(): void {
    for (const [id, { node }] of this.cards) {
      if (node.isConnected) continue;
      this.inView.unobserve(node);
      this.cards.delete(id);
    }
  }

  private explain(sentence: string): void {
    this.message.hidden = false;
    setText(this.message, sentence);
  }
}

void new JobsPage().start();
