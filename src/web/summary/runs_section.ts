// SPDX-License-Identifier: Apache-2.0
/** The recordings one by one: how each ended, when, and the command that makes its report. */

import { badge } from '../shared/badge';
import { button, el, text } from '../shared/dom';
import { localTime } from '../shared/local_time';
import { identifier, visible } from '../shared/names';
import { typeset } from '../shared/prose';
import { section } from '../shared/section';
import { table, type Cell } from '../shared/table';
import type { ListedRun, Summary } from './types';
import { countText, counted } from './words';

const kShown = 12; // rows before the others are asked for

const kNews = { new: 'new', again: 'fitted again' };

/** A button that shows the command and copies it. A browser that does not let the page copy leaves it selected. */
function reportCell({ id, command }: ListedRun): Cell {
  if (command === null) return '–';
  const code = el('code', { class: 'command', tabindex: '-1' }, visible(command));
  const said = el('span', { role: 'status', class: 'quiet' });
  const copy = async (): Promise<void> => {
    code.hidden = false;
    getSelection()?.selectAllChildren(code);
    said.textContent = await navigator.clipboard.writeText(command).then(
      () => 'Copied: paste it in a terminal.',
      () => 'Copy it to a terminal.',
    );
  };
  code.hidden = true;
  return [button('Command', () => void copy(), { 'aria-label': `Command for the report of ${visible(id)}` }), said, code];
}

const row = (run: ListedRun): Cell[] => [
  identifier(run.id),
  [
    badge(run.state, run.level),
    run.level !== 'good' && run.text !== null && el('small', {}, typeset(visible(run.text))),
  ],
  run.model ?? '–',
  run.fitted === null ? '–' : localTime(run.fitted),
  run.news === null ? 'as before' : kNews[run.news],
  reportCell(run),
];

function runTable(runs: ListedRun[]): HTMLElement {
  const heads = ['Recording', 'State', 'Law', 'Fitted', 'Last refit', 'Report'];
  const box = table('Recordings that need a look first', heads.map((head) => ({ head })), runs.map(row));
  box.classList.add('ids', 'recordings');
  return box;
}

export function runsSection({ headline, runs = [] }: Summary): HTMLElement | null {
  if (runs.length === 0) return null;
  const box = el('div', {}, runTable(runs.slice(0, kShown)));
  const all = button(`Show all ${countText(runs.length)} recordings`, () => {
    box.replaceChildren(runTable(runs));
    box.querySelector<HTMLElement>('.scroll')?.focus();
    all.remove();
  });
  const left = headline.runs - runs.length;
  return section(
    'runs',
    'The recordings',
    text('The command of a recording writes its report. Give it in the folder in which the batch was fitted.', 'quiet'),
    box,
    runs.length > kShown && all,
    left > 0 && text(`${counted(left, 'more recording')} are in the store.`, 'quiet'),
  );
}
