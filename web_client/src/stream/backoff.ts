// Delays between attempts to reconnect: exponential back-off, capped, with jitter so that the
// viewers of a restarted server do not all reconnect at the same time.
export class Backoff {
  private attempts = 0;
  private readonly firstDelayMs: number;
  private readonly maxDelayMs: number;
  private readonly random: () => number;

  constructor(firstDelayMs = 400, maxDelayMs = 10_000, random: () => number = Math.random) {
    this.firstDelayMs = firstDelayMs;
    this.maxDelayMs = maxDelayMs;
    this.random = random;
  }

  /** Milliseconds to wait before the next attempt; between half and all of the current bound. */
  next(): number {
    const bound = Math.min(this.maxDelayMs, this.firstDelayMs * 2 ** this.attempts);
    this.attempts += 1;
    return Math.round(bound * (0.5 + 0.5 * this.random()));
  }

  reset(): void {
    this.attempts = 0;
  }
}
