// SPDX-License-Identifier: Apache-2.0
/** Work for values that change faster than it is done. */

/**
 * Does the work for the newest value: one at a time, and never for a value that a newer one replaced while it waited.
 * `work` gets a signal that is aborted when its value is dropped. After work that throws, the next value has its turn.
 */
export class Newest<T> {
  private waiting: { value: T } | null = null;
  private running: AbortController | null = null;

  constructor(private readonly work: (value: T, dropped: AbortSignal) => Promise<void>) {}

  /** Resolves at once while other work runs, otherwise when the work for this value is done. Rejects if it throws. */
  ask(value: T): Promise<void> {
    this.waiting = { value };
    return this.next();
  }

  /** Nobody wants the values any more for which work runs or waits. */
  drop(): void {
    this.waiting = null;
    this.running?.abort();
  }

  private async next(): Promise<void> {
    if (this.running || !this.waiting) return;
    const { value } = this.waiting;
    this.waiting = null;
    this.running = new AbortController();
    try {
      await this.work(value, this.running.signal);
    } finally {
      this.running = null;
      void this.next();
    }
  }
}
