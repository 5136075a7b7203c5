// Input latency: the time from sending a camera to drawing the first frame that shows it.
export class LatencyMeter {
  private readonly sent = new Map<number, number>();
  private readonly recent: number[] = [];
  private readonly window: number;
  private newestEcho = 0;

  constructor(window = 15) {
    this.window = window;
  }

  /** Records when a camera was sent. All times in milliseconds on one clock. */
  inputSent(seq: number, at: number): void {
    this.sent.set(seq, at);
  }

  /**
   * Takes a drawn frame. Returns its latency, or null when it shows no newer camera than the last:
   * frames that refine a static view repeat the echo and would measure the idle time.
   */
  frameDrawn(inputSeqEcho: number, at: number): number | null {
    if (inputSeqEcho <= this.newestEcho) return null;
    this.newestEcho = inputSeqEcho;
    const sentAt = this.sent.get(inputSeqEcho);
    for (const seq of this.sent.keys()) {
      if (seq <= inputSeqEcho) this.sent.delete(seq);
    }
    if (sentAt === undefined) return null;
    const latency = at - sentAt;
    this.recent.push(latency);
    if (this.recent.length > this.window) this.recent.shift();
    return latency;
  }

  /** Median of the recent measurements in milliseconds; null before the first. */
  get median(): number | null {
    if (this.recent.length === 0) return null;
    const sorted = [...this.recent].sort((a, b) => a - b);
    return sorted[sorted.length >> 1] ?? null;
  }

  /** Discards pending inputs: a new connection starts with new sequence numbers. */
  reset(): void {
    this.sent.clear();
    this.newestEcho = 0;
  }
}
