// SPDX-License-Identifier: Apache-2.0
/** Buttons of a fit: download, rename, copy a link, compare, delete. */

import { button, details, el } from '../../shared/dom';
import { confirmed, showText } from '../dialog';
import { download, stem } from '../download';
import { go } from '../router';
import { fitApi } from '../routes';
import { select, unselect } from '../selection';
import { ask } from '../server/api';
import type { Place } from '../shell';
import type { FitRequest } from '../types';
import { attempt } from './problem_view';
import { askName } from './rename';

/** Label, part of the fit in the service, file extension. */
const kParts: [string, string, string][] = [
  ['Result (JSON)', '', '.json'],
  ['Report (HTML page)', 'report', '.html'],
  ['Report (Markdown)', 'markdown', '.md'],
  ['Residuals (CSV)', 'residuals', '_residuals.csv'],
  ['Series (JSON)', 'series', '_series.json'],
  ['Recording as sent', 'recording', '.csv'],
];

function downloads(request: FitRequest, fitted: boolean, problems: HTMLElement, { signal }: Place): HTMLElement {
  const { id } = request;
  const list = el('ul', { class: 'downloads' });
  for (const [words, part, ending] of fitted ? kParts : kParts.slice(-1)) {
    const press = button(words, () => {
      close();
      const file = stem(request.name) + ending;
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

/** Asks for a name and gives it to the fit. An empty one brings that of the file back. */
async function rename(
  request: FitRequest,
  control: HTMLButtonElement,
  problems: HTMLElement,
  place: Place,
): Promise<void> {
  const name = await askName(request.name === request.file ? '' : request.name, request.file);
  if (name === null) return;
  await attempt(control, problems, async () => {
    const headers = { 'Content-Type': 'application/json' };
    const body = JSON.stringify({ name });
    const answer = await ask(fitApi(request.id), { method: 'PATCH', body, headers, signal: place.signal });
    request.name = ((await answer.json()) as { name: string }).name;
    place.name(request.name);
    place.say(`Renamed: ${request.name}.`);
  });
}

async function remove(
  { id, name }: FitRequest,
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
export function fitActions(
  request: FitRequest,
  fitted: boolean,
  problems: HTMLElement,
  place: Place,
): HTMLElement {
  const copy = button('Copy link', () => void copyLink(say));
  const said = el('span', { role: 'status', class: 'quiet' });
  const say = (words: string): void => void (said.textContent = words);
  const compare = button('Compare', () => {
    select(request.id, request.name);
    go('/fits');
  });
  const press = button('Delete', () => void remove(request, press, problems, place), { class: 'danger' });
  const another = button('Rename', () => void rename(request, another, problems, place));
  compare.hidden = !fitted;
  return el(
    'div',
    { class: 'actions fit-actions' },
    downloads(request, fitted, problems, place),
    another,
    copy,
    compare,
    press,
    said,
  );
}
