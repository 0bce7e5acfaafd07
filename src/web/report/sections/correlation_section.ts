// SPDX-License-Identifier: Apache-2.0
import { el, symbolElement } from '../../shared/dom';
import type { NamedMatrix, Num } from '../../shared/result_types';
import { fixed } from '../../shared/rounding';
import { absent, section } from '../../shared/section';
import { scrollBox } from '../../shared/table';
import { symbolOf, wordsOf } from '../../shared/units';
import { shownFit, type Report } from '../report';

const kDeepest = 55; // % of colour at a correlation of ±1; text on it stays readable

/** A table cell with its colour: blue for positive, orange for negative correlation. */
function cell(value: Num, diagonal: boolean): HTMLElement {
  if (value === null) return el('td', { class: 'number' }, '–');
  const element = el('td', { class: diagonal ? 'number diagonal' : 'number' }, diagonal ? '1' : fixed(value, 2));
  const name = value < 0 ? 'negative' : 'positive';
  const share = Math.round(Math.min(1, Math.abs(value)) * kDeepest);
  if (!diagonal) element.style.background = `color-mix(in srgb, var(--${name}) ${share}%, transparent)`;
  return element;
}

const short = (name: string): Node | string => {
  const symbol = symbolOf(name);
  return symbol === null ? name : symbolElement(symbol);
};

function matrixTable({ names, matrix }: NamedMatrix): HTMLElement {
  const caption = 'Correlations of the estimates';
  const head = el('tr', {}, el('td'));
  for (const name of names) head.append(el('th', { scope: 'col', class: 'number', title: wordsOf(name) }, short(name)));
  const body = el('tbody');
  names.forEach((name, i) => {
    const row = el('tr', {}, el('th', { scope: 'row' }, `${wordsOf(name)} `, short(name)));
    names.forEach((_other, j) => row.append(cell(matrix[i]?.[j] ?? null, i === j)));
    body.append(row);
  });
  return scrollBox(caption, el('table', { class: 'matrix' }, el('caption', {}, caption), el('thead', {}, head), body));
}

/** The two parameters with the largest correlation, in words. */
function strongest({ names, matrix }: NamedMatrix): string {
  let [row, column, most] = [0, 0, 0];
  names.forEach((_name, i) =>
    names.forEach((_other, j) => {
      const size = Math.abs(matrix[i]?.[j] ?? 0);
      if (j < i && size > most) [row, column, most] = [i, j, size];
    }),
  );
  const pair = `${wordsOf(names[row])} and ${wordsOf(names[column])}, ${fixed(matrix[row]?.[column] ?? 0, 2)}`;
  const meaning = most > 0.95 ? ': the recording determines their combination far better than each of them' : '';
  return `The strongest is that of ${pair}${meaning}.`;
}

export function correlationSection(report: Report): HTMLElement {
  const correlation = shownFit(report)?.correlation;
  const title = 'Correlations';
  if (!correlation || correlation.names.length < 2) {
    return section(
      'correlation',
      title,
      absent('Fewer than two parameters have standard errors, so there are no correlations.'),
    );
  }
  return section('correlation', title, el('p', {}, strongest(correlation)), matrixTable(correlation));
}
