// SPDX-License-Identifier: Apache-2.0
/** Short texts in the storage of the browser. It may refuse to store anything for a page that was opened as a file. */

/** How long a text is kept: until the tab is closed, or until the user clears the storage. */
export type Until = 'closed' | 'cleared';

const storage = (until: Until): Storage => (until === 'closed' ? sessionStorage : localStorage);

/** The text that was kept under this name; null if there is none. */
export function kept(until: Until, name: string): string | null {
  try {
    return storage(until).getItem(name);
  } catch {
    return null;
  }
}

/** Keeps a text. If the browser refuses or has no space left, nothing is kept and no error is reported. */
export function keep(until: Until, name: string, words: string): void {
  try {
    storage(until).removeItem(name); // so that no outdated text remains if there is no space for the new one
    if (words !== '') storage(until).setItem(name, words);
  } catch {
    // the text is lost when the page is closed
  }
}
