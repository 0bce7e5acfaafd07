// SPDX-License-Identifier: Apache-2.0
/** Buttons of a fit: download, copy a link, compare, delete. */

import { button, details, el } from '../../shared/dom';
import { confirmed, showText } from '../dialog';
import { download, stem } from '../download';
import { go } from '../router';
import { fitApi } from '../routes';
import { select, unselect } from '../selection';
import { ask } from '../server/api';
import type { Place } from '../shell';
import { attempt } from './problem_view';

/** Label, part of the fit in the service, file extension. */
const kParts: [string, string, string][] = [
  ['Result (JSON)', '', '.json'],
  ['Report (HTML page)', 'report', '.html'],
  ['Report (Markdown)', 'markdown', '.md'],
  ['Residuals (CSV)', 'residuals', '_residuals.csv'],
  ['Series (JSON)', 'series', '_series.json'],
  ['Recording as sent', 'recording', '.csv'],
];

function downloads(id: string, name: string, fitted: boolean, problems: HTMLElement, { signal }: Place): HTMLElement {
  const list = el('ul', { class: 'downloads' });
  for (const [words, part, ending] of fitted ? kParts : kParts.slice(-1)) {
    const file = stem(name) + ending;
    const press = button(words, () => {
      close();
      void attempt(press, problems, () => download(fitApi(id, part), file, signal));
    });
    list.append(el('li', {}, press));
  }
  const menu = details('Download', () => list);
  const close = (): void => {
    menu.open = false;
    menu.querySelector('summary')?.focus();
  };
  document.addEventListener('pointerdown', (event) => menu.contains(event.target as Node) || (menu.open = false), {
    signal,
  });
  menu.addEventListener('keydown', (event) => {
    if (event.key === 'Escape' && menu.open) close();
  });
  return menu;
}

async function copyLink(say: (words: string) => void): Promise<void> {
  const address = location.href.split('#')[0];
  try {
    await navigator.clipboard.writeText(address);
    say('The link is copied.');
  } catch {
    showText('The link to this fit', address);
  }
}

async function remove(
  id: string,
  name: string,
  control: HTMLButtonElement,
  problems: HTMLElement,
  place: Place,
): Promise<void> {
  const consequence = 'The result and the recording are removed from the service for good.';
  if (!(await confirmed(`Delete “${name}”?`, consequence, 'Delete'))) return;
  await attempt(control, problems, async () => {
    await ask(fitApi(id), { method: 'DELETE', signal: place.signal });
    unselect(id);
    go('/fits', true);
  });
}

/** The row of buttons below the heading of a fit. `fitted`: the fit has a result. */
export function fitActions(id: string, name: string, fitted: boolean, problems: HTMLElement, place: Place): HTMLElement {
  const copy = button('Copy link', () => void copyLink(say));
  const said = el('span', { role: 'status', class: 'quiet' });
  const say = (words: string): void => void (said.textContent = words);
  const compare = button('Compare with …', () => {
    select(id, name);
    go('/fits');
  });
  const press = button('Delete', () => void remove(id, name, press, problems, place), { class: 'danger' });
  compare.hidden = !fitted;
  return el(
    'div',
    { class: 'actions fit-actions' },
    downloads(id, name, fitted, problems, place),
    copy,
    compare,
    press,
    said,
  );
}
