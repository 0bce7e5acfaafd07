// SPDX-License-Identifier: Apache-2.0
/** Reads the JSON that is embedded in a page, and starts its script. */

import { el } from './dom';

/** The JSON of the script element with this id; null if it is missing or empty. */
export function embedded<T>(id: string): T | null {
  const content = document.getElementById(id)?.textContent?.trim() ?? '';
  const filled = /^[{[]/.test(content) ? content : 'null';
  return JSON.parse(filled) as T | null;
}

/** Calls `fill` with the element of this id. An error is shown in the element. */
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
