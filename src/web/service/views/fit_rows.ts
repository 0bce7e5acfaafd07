// SPDX-License-Identifier: Apache-2.0
/** Fits as rows of a table, which becomes a list of cards on a narrow page. */

import { badge, type State } from '../../shared/badge';
import { append, el, symbolElement, type Child } from '../../shared/dom';
import { localTime } from '../../shared/local_time';
import { mainFit } from '../../shared/main_fit';
import { numberText, typeset } from '../../shared/prose';
import { windowText } from '../../shared/rounding';
import { symbolOf, unitText } from '../../shared/units';
import { fitPath } from '../routes';
import type { FitItem, ItemModel } from '../types';

/** The parameters that a list shows, and their headings. */
export const kParameters = [
  ['inertia', 'Inertia'],
  ['viscous', 'Viscous'],
  ['coulomb', 'Dry'],
] as const;

/** The model that a list shows of a fit. */
export function mainModel(item: Pick<FitItem, 'recommended' | 'models'>): ItemModel | null {
  return mainFit(item.models, item.recommended, (model) => model.rms_residual);
}

/** "0.0790 ± 0.0028" and "kg m²", "s², over G" without a rig; "–" if the model has no such parameter. */
export function parameterWords(model: ItemModel | null, name: string): { value: string; unit: string } {
  const parameter = model?.parameters?.[name];
  if (!parameter || parameter.estimate === null) return { value: '–', unit: '' };
  const overG = symbolOf(name, parameter.unit)?.endsWith('/G') ? 'over G' : '';
  const unit = [unitText(parameter.unit), overG].filter((part) => part !== '').join(', ');
  return { value: numberText(parameter.text), unit };
}

function parameterCell(model: ItemModel | null, name: string, label: string): HTMLElement {
  const { value, unit } = parameterWords(model, name);
  return cell(label, value, ' ', unit !== '' && el('small', {}, unit));
}

/** Whether a run has no result. The exit codes of fits are 0 and 1. */
export const isUnfitted = ({ exit_code: code }: Pick<FitItem, 'exit_code'>): boolean => (code ?? 0) > 1;

/** How a fit ended, in words. */
export function stateOf(item: Pick<FitItem, 'state' | 'exit_code' | 'recommended' | 'models'>): {
  words: string;
  level: State;
} {
  if (item.state === 'waiting') return { words: 'waiting', level: 'waiting' };
  if (isUnfitted(item)) return { words: 'not fitted', level: 'bad' };
  const status = mainModel(item)?.status;
  if (status === undefined) return { words: 'closed forms', level: 'good' };
  if (status === 'converged') return { words: 'converged', level: 'good' };
  return { words: status.replace(/_/g, ' '), level: status === 'failed' ? 'bad' : 'caution' };
}

function cell(label: string, ...children: Child[]): HTMLElement {
  return el('td', { role: 'cell', 'data-label': label }, el('span', {}, ...children));
}

/** The name of a fit as a link to it. A waiting run has no link yet. */
function nameCell(item: FitItem): HTMLElement {
  const name = item.name || 'recording without a name';
  const shown = el('bdi', {}, name);
  const linked = item.state === 'waiting' ? shown : el('a', { href: fitPath(item.id) }, shown);
  const file = item.file !== undefined && item.file !== name && el('small', {}, el('bdi', {}, item.file));
  const why = isUnfitted(item) && item.reason !== '' && el('small', {}, typeset(item.reason));
  return el('th', { scope: 'row', role: 'rowheader' }, linked, file, why);
}

/** Ids and names of the selected fits. `changed` is called after a change. */
export interface Selection {
  ids: Map<string, string>;
  changed: () => void;
}

function selectCell(item: FitItem, { ids, changed }: Selection): HTMLElement {
  const input = el('input', { type: 'checkbox', 'aria-label': `Select ${item.name}` });
  input.checked = ids.has(item.id);
  input.disabled = item.state === 'waiting' || isUnfitted(item);
  input.addEventListener('change', () => {
    if (input.checked) ids.set(item.id, item.name);
    else ids.delete(item.id);
    changed();
  });
  return el('td', { role: 'cell', class: 'select-cell' }, el('label', { class: 'box' }, input));
}

/** "0 to 46.35 s" */
export function windowWords(window: readonly [number, number] | null | undefined): string {
  return window ? windowText(window) : '–';
}

/** isPast: a row of the list of past fits, else of a batch. */
export function fitRow(item: FitItem, selection: Selection, isPast = true): HTMLTableRowElement {
  const model = mainModel(item);
  const { words, level } = stateOf(item);
  const row = el('tr', { role: 'row', 'data-id': item.id }, selectCell(item, selection), nameCell(item));
  const values = kParameters.map(([name, label]) => parameterCell(model, name, label));
  append(row, [cell('Law', model?.model ?? '–'), isPast && cell('Window', windowWords(item.window_s)), ...values]);
  append(row, [cell('Status', badge(words, level)), isPast && cell('When', localTime(item.created, true))]);
  return row;
}

/** An empty table for rows of fits. */
export function fitTable(caption: string, isPast = true): { element: HTMLElement; body: HTMLElement } {
  const head = el('tr', { role: 'row' }, el('td', { role: 'cell' }));
  const heading = (...words: Child[]): void =>
    void head.append(el('th', { scope: 'col', role: 'columnheader' }, ...words));
  heading(isPast ? 'Name or file' : 'Recording');
  heading('Law');
  if (isPast) heading('Window');
  for (const [name, label] of kParameters) {
    heading(`${label} `, symbolElement(symbolOf(name) ?? name), isPast && ', total error');
  }
  heading('Status');
  if (isPast) heading('When');
  const body = el('tbody', { role: 'rowgroup' });
  const table = el(
    'table',
    { class: 'runs', role: 'table' },
    el('caption', {}, caption),
    el('thead', { role: 'rowgroup' }, head),
    body,
  );
  return { element: el('div', { class: 'runs-box' }, table), body };
}
