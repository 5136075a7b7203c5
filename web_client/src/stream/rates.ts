// Frames and bytes per second over a sliding window.
export class RateMeter {
  private readonly entries: { at: number; bytes: number }[] = [];
  private readonly windowMs: number;

  constructor(windowMs = 1500) {
    this.windowMs = windowMs;
  }

  add(at: number, bytes: number): void {
    this.entries.push({ at, bytes });
    this.dropOld(at);
  }

  /** Rates at the given time. Both are zero when no frame came within the window. */
  read(now: number): { fps: number; bytesPerSecond: number } {
    this.dropOld(now);
    const first = this.entries[0];
    const last = this.entries[this.entries.length - 1];
    if (!first || !last || this.entries.length < 2) return { fps: 0, bytesPerSecond: 0 };
    const seconds = (last.at - first.at) / 1000;
    if (seconds <= 0) return { fps: 0, bytesPerSecond: 0 };
    const bytes = this.entries.reduce((sum, entry) => sum + entry.bytes, 0) - first.bytes;
    return { fps: (this.entries.length - 1) / seconds, bytesPerSecond: bytes / seconds };
  }

  private dropOld(now: number): void {
    while (this.entries[0] && now - this.entries[0].at > this.windowMs) this.entries.shift();
  }
}
