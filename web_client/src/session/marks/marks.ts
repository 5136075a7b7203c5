// What viewers have added to the scene for each other.

import type { Notifications } from "heliograph/messages.ts";
import { Annotations } from "./annotations.ts";
import type { MarksHost } from "./mark_store.ts";
import { Measurements } from "./measurements.ts";

export class Marks {
  readonly measurements: Measurements;
  readonly annotations: Annotations;

  constructor(host: MarksHost) {
    this.measurements = new Measurements(host);
    this.annotations = new Annotations(host);
  }

  /** Of the session that the page is in now. */
  read(): void {
    void this.measurements.read();
    void this.annotations.read();
  }

  /** Adds what this page knows to another session that shows the same scene and has none. */
  async restore(): Promise<void> {
    await this.measurements.restore();
    await this.annotations.restore();
  }

  /** Takes a change by another viewer. */
  notified(method: string, params: unknown): void {
    if (method === "annotations.changed") {
      this.annotations.take((params as Notifications["annotations.changed"]).list);
    } else {
      this.measurements.take((params as Notifications["measurements.changed"]).list);
    }
  }
}
