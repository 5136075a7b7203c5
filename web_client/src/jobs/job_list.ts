// A section of the page: jobs in one state, or those that have ended.

import { element, setText, uniqueId } from "../widgets/element.ts";
import type { JobCard } from "./job_card.ts";

export class JobList {
  readonly node: HTMLElement;
  private readonly list = element("div", { class: "jobs" });
  private readonly heading: HTMLElement;
  private readonly title: string;
  private readonly note = element("p", { class: "figures", hidden: true });

  constructor(title: string) {
    this.title = title;
    const id = uniqueId("section");
    this.heading = element("h2", { id });
    this.node = element(
      "section",
      { "aria-labelledby": id, hidden: true },
      this.heading,
      this.list,
      this.note,
    );
  }

  /** The cards in this order; `count`: of all jobs, which may be more. */
  show(cards: JobCard[], count: number): void {
    this.node.hidden = cards.length === 0;
    setText(this.heading, `${this.title} (${count})`);
    // Cards that stay where they are keep the focus.
    cards.forEach(({ node }, index) => {
      const there = this.list.children[index] ?? null;
      if (there !== node) this.list.insertBefore(node, there);
    });
    while (this.list.childElementCount > cards.length) this.list.lastElementChild?.remove();
    const left = count - cards.length;
    this.note.hidden = left <= 0;
    setText(this.note, `${left} more are not shown`);
  }
}
