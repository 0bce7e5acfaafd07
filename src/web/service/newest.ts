// SPDX-License-Identifier: Apache-2.0
/** Work for values that change faster than it is done. */

/**
 * A function that does the work for its newest value: one at a time, and never for a value that a newer one replaced
 * while it waited. `work` must not throw.
 */
export function forNewest<T>(work: (value: T) => Promise<void>): (value: T) => Promise<void> {
  let waiting: { value: T } | null = null;
  let running: Promise<void> | null = null;
  const run = async (): Promise<void> => {
    while (waiting) {
      const { value } = waiting;
      waiting = null;
      await work(value);
    }
    running = null;
  };
  return (value) => {
    waiting = { value };
    running ??= run();
    return running;
  };
}
