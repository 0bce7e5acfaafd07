// SPDX-License-Identifier: Apache-2.0
/** Small things that the browser keeps, where it allows that: a page opened as a file may be refused. */

/** Until the tab is closed, or for good. */
export type Until = 'closed' | 'cleared';

const storage = (until: Until): Storage => (until === 'closed' ? sessionStorage : localStorage);

/** What was kept under a name; null of nothing. */
export function kept(until: Until, name: string): string | null {
  try {
    return storage(until).getItem(name);
  } catch {
    return null;
  }
}

/** Keeps it. Without a right to, or without room, it is lost with the page, as it was before. */
export function keep(until: Until, name: string, words: string): void {
  try {
    storage(until).removeItem(name); // lest the former words outlive a lack of room
    if (words !== '') storage(until).setItem(name, words);
  } catch {
    // nobody waits for it
  }
}
