// SPDX-License-Identifier: Apache-2.0
import { el, type Child } from '../shared/dom';
import { countText, shareText } from './words';

/** A list of names with their counts as bars. A full bar is `total`. */
export function barList(label: string, rows: { name: Child; count: number }[], total: number): HTMLElement {
  const list = el('ul', { class: 'bars', 'aria-label': label });
  for (const { name, count } of rows) {
    const bar = el('span', { class: 'filled' });
    bar.style.width = `${total > 0 ? (100 * count) / total : 0}%`;
    list.append(
      el(
        'li',
        {},
        el('span', { class: 'name' }, name),
        el('span', { class: 'track', 'aria-hidden': 'true' }, bar),
        el('span', { class: 'count' }, `${countText(count)} (${shareText(count, total)})`),
      ),
    );
  }
  return list;
}
