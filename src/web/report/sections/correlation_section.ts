// SPDX-License-Identifier: Apache-2.0
import { el, symbolElement } from '../../shared/dom';
import type { NamedMatrix, Num } from '../../shared/result_types';
import { fixed } from '../../shared/rounding';
import { absent, section } from '../../shared/section';
import { scrollBox } from '../../shared/table';
import { symbolOf, wordsOf } from '../../shared/units';
import { contourPart } from '../contours';
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

/** Rows of the two parameters with the largest correlation. */
function strongest({ names, matrix }: NamedMatrix): [number, number] {
  let [row, column, most] = [1, 0, 0];
  names.forEach((_name, i) =>
    names.forEach((_other, j) => {
      const size = Math.abs(matrix[i]?.[j] ?? 0);
      if (j < i && size > most) [row, column, most] = [i, j, size];
    }),
  );
  return [row, column];
}

const kAlmostOne = 0.95;

function strongestText({ names, matrix }: NamedMatrix, [row, column]: [number, number]): string {
  const value = matrix[row]?.[column] ?? 0;
  const meaning =
    Math.abs(value) > kAlmostOne ? ' The recording determines their combination much better than each of them.' : '';
  const pair = `${wordsOf(names[row])} and ${wordsOf(names[column])}`;
  return `The strongest correlation is between ${pair}: ${fixed(value, 2)}.${meaning}`;
}

export function correlationSection(report: Report): HTMLElement {
  const fit = shownFit(report);
  const title = 'Correlations';
  if (!fit || fit.correlation.names.length < 2) {
    return section(
      'correlation',
      title,
      absent('Fewer than two parameters have standard errors, so there are no correlations.'),
    );
  }
  const { correlation } = fit;
  const pair = strongest(correlation);
  const [row, column] = pair;
  return section(
    'correlation',
    title,
    el('p', {}, strongestText(correlation, pair)),
    el(
      'div',
      { class: 'pair' },
      matrixTable(correlation),
      contourPart(fit, correlation.names, [correlation.names[column], correlation.names[row]]),
    ),
  );
}
