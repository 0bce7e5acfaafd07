// SPDX-License-Identifier: Apache-2.0
import { el } from './dom';

export type State = 'good' | 'caution' | 'bad' | 'waiting';

/** How something ended: words, with the colour of their state. */
export function badge(words: string, level: State): HTMLElement {
  return el('span', { class: `badge ${level}-badge` }, words);
}
