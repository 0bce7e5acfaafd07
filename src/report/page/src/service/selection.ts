// SPDX-License-Identifier: Apache-2.0
/** Fits chosen to be compared, from whatever view. */

import { button, el } from '../dom';
import type { Selection } from './fit_rows';
import { go } from './router';
import { comparePath, kMostCompared } from './routes';

const chosen = new Map<string, string>();

/** Chooses a fit. */
export const select = (id: string, name: string): void => void chosen.set(id, name);

/** No longer chosen, such as what was deleted. */
export const unselect = (id: string): void => void chosen.delete(id);

/** What is chosen, and the bar that tells it; `more`: further actions on what is chosen. */
export function selectionBar(more: HTMLButtonElement[] = []): { selection: Selection; bar: HTMLElement } {
  const words = el('p', { role: 'status', class: 'quiet' });
  const compare = button('Compare', () => go(comparePath([...chosen.keys()])), { class: 'primary' });
  const changed = (): void => {
    const names = [...chosen.values()];
    const many = names.length > kMostCompared;
    compare.disabled = names.length < 2 || many;
    for (const other of more) other.disabled = names.length === 0;
    const told = names.length > 3 ? `${names.length} fits` : names.join(', ');
    words.textContent = many
      ? `${names.length} are selected; at most ${kMostCompared} can be compared.`
      : names.length === 0
        ? 'Select two or more to compare them.'
        : `Selected: ${told}.${names.length === 1 ? ' Select another one to compare with it.' : ''}`;
  };
  changed();
  return {
    selection: { ids: chosen, changed },
    bar: el('div', { class: 'actions selection' }, words, compare, ...more),
  };
}
