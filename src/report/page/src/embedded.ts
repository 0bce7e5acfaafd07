// SPDX-License-Identifier: Apache-2.0
/** What stands in a page beside its script: JSON, and the place that is to be filled. */

import { el } from './dom';

/** The JSON of a script element; null where there is none. */
export function embedded<T>(id: string): T | null {
  const content = document.getElementById(id)?.textContent?.trim() ?? '';
  const filled = /^[{[]/.test(content) ? content : 'null';
  return JSON.parse(filled) as T | null;
}

/** Fills the place of that id; what cannot be shown says why there. */
export function start(id: string, what: string, fill: (root: HTMLElement) => void): void {
  const root = document.getElementById(id);
  if (!root) return;
  try {
    fill(root);
  } catch (error) {
    const why = error instanceof Error ? error.message : String(error);
    root.replaceChildren(el('p', { class: 'fatal', role: 'alert' }, `This ${what} cannot be shown: ${why}`));
    throw error;
  }
}
