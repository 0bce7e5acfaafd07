// SPDX-License-Identifier: Apache-2.0
/** The verdict above a page, and the list of warnings. */

import { el } from './dom';
import { placeInGuide } from './guide';
import { sentence } from './prose';
import type { Warning } from './result_types';

export type Level = 'good' | 'caution' | 'bad';

export interface Headline {
  level: Level;
  title: string;
  sentence: string;
}

const kSigns: Record<Level, string> = { good: '✓', caution: '!', bad: '✕' };

/** `more`: a further line. */
export function banner({ level, title, sentence: words }: Headline, more: HTMLElement | null = null): HTMLElement {
  const box = el('div', {}, el('p', { class: 'title' }, title), words !== '' && el('p', {}, words), more);
  return el(
    'div',
    { class: `banner ${level}` },
    el('span', { class: 'sign', 'aria-hidden': 'true' }, kSigns[level]),
    box,
  );
}

type Told = Pick<Warning, 'code' | 'message'>;

export function warningList(list: Told[]): HTMLElement {
  const items = el('ul', { class: 'warnings' });
  for (const { code, message } of list) {
    const name = el('span', { class: 'code' }, code.replace(/_/g, ' '));
    items.append(el('li', {}, name, ' ', sentence(message), ' ', placeInGuide(code)));
  }
  return items;
}

export function warnings({ warnings: list }: { warnings: Told[] }): HTMLElement | null {
  if (list.length === 0) return el('p', { class: 'quiet' }, 'No warnings.');
  return el('div', {}, el('h3', {}, list.length === 1 ? 'Warning' : `Warnings (${list.length})`), warningList(list));
}
