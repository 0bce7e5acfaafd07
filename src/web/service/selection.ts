// SPDX-License-Identifier: Apache-2.0
/** The fits that are selected for a comparison, in any view. */

import { button, el } from '../shared/dom';
import { go } from './router';
import { comparePath, kMostCompared } from './routes';
import type { Selection } from './views/fit_rows';

const chosen = new Map<string, string>();

/** Selects a fit. */
export const select = (id: string, name: string): void => void chosen.set(id, name);

/** Removes fits from the selection, for example deleted ones. */
export const unselect = (id: string): void => void chosen.delete(id);

/** The selection, and the bar that shows it. `more`: further actions on the selected fits. */
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
