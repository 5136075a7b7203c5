// Waiting times between attempts to reconnect: exponential, capped, with jitter so that many
// viewers of a restarted server do not all come back in the same instant.
export class Backoff {
  private attempts = 0;
  private readonly firstMs: number;
  private readonly longestMs: number;
  private readonly random: () => number;

  constructor(firstMs = 400, longestMs = 10_000, random: () => number = Math.random) {
    this.firstMs = firstMs;
    this.longestMs = longestMs;
    this.random = random;
  }

  /** Milliseconds to wait before the next attempt; between half and all of the current bound. */
  next(): number {
    const bound = Math.min(this.longestMs, this.firstMs * 2 ** this.attempts);
    this.attempts += 1;
    return Math.round(bound * (0.5 + 0.5 * this.random()));
  }

  reset(): void {
    this.attempts = 0;
  }
}
