// SPDX-License-Identifier: Apache-2.0
/** Whether runs of one rig scatter as their error bars say. */

import { details, el, text } from '../shared/dom';
import type { ForestRow } from '../shared/forest';
import { clippedWords, forestPlot, forestSentence } from '../shared/forest_plot';
import { identifier, visible } from '../shared/names';
import { numberText, sentence } from '../shared/prose';
import { absent, figure, section } from '../shared/section';
import { facts, table, type Cell, type Column } from '../shared/table';
import { unitText, wordsOf } from '../shared/units';
import { meanRows, rowsToDraw, scatterRows } from './repeatability';
import type { GroupRow, ParameterSummary, Repeatability } from './types';
import { countText, withUnitOf } from './words';

const kOpenRows = 12; // of a table that is not collapsed, at most
const kMostRows = 500;

function numbers({ texts, between_std_dev: between, ...found }: Repeatability, unit: string): HTMLElement {
  return facts([
    ['scatter ÷ error bars', numberText(texts.scatter_ratio)],
    ['χ², degrees of freedom', `${numberText(texts.chi2)}, ${countText(found.dof)}`],
    ['p if the errors are right', numberText(texts.p)],
    ['scatter beyond the error bars', between === 0 ? 'none' : withUnitOf(texts.between_std_dev, unit)],
    ['groups', countText(found.groups)],
    ['runs', countText(found.runs)],
  ]);
}

const row = ({ group, disagrees, runs, texts }: GroupRow): Cell[] => [
  [identifier(group), disagrees && el('small', { class: 'no' }, 'disagrees')],
  countText(runs),
  numberText(texts.weighted_mean),
  numberText(texts.scatter_ratio),
  texts.scatter_interval95,
  numberText(texts.p),
];

function groupTable({ rows }: Repeatability, group: string, unit: string): HTMLElement {
  const number = 'number' as const;
  const columns: Column[] = [
    { head: visible(group) },
    { head: 'Runs', kind: number },
    { head: `Weighted mean ± error${unit && ` [${unit}]`}`, kind: number },
    { head: 'Scatter ÷ error bars', kind: number },
    { head: '95 % interval', kind: number },
    { head: 'p', kind: number },
  ];
  const shown = rows.slice(0, kMostRows);
  const box = table(
    'By group',
    columns,
    shown.map(row),
  );
  box.classList.add('ids');
  return box;
}

function plot(heading: string, rows: ForestRow[], what: string, unit: string, words: string): HTMLElement | null {
  const drawing = forestPlot(forestSentence(what, unit, rows), rows);
  return (
    drawing &&
    el(
      'div',
      {},
      el('h3', {}, heading),
      figure([words, clippedWords(rows)].filter((part) => part !== '').join(' '), drawing),
    )
  );
}

function plots(one: ParameterSummary, found: Repeatability): HTMLElement {
  const left = found.rows.length - rowsToDraw(found.rows).length;
  const most =
    left > 0
      ? `The ${rowsToDraw(found.rows).length} groups of ${countText(found.rows.length)} that agree least with their error bars.`
      : '';
  const unit = unitText(one.unit);
  const means = `Weighted means and their 95 % intervals; rigs may differ.`;
  const box = el('div', { class: 'pair' });
  for (const part of [
    plot(
      'Scatter of the runs ÷ their error bars',
      scatterRows(found),
      'scatter over error bars by group',
      '',
      `${most} With 95 % intervals; 1 (dashed) if the errors are right.`.trim(),
    ),
    plot(
      `Mean${unit && ` [${unit}]`}`,
      meanRows(found),
      `mean ${wordsOf(one.name)} by group`,
      unit,
      `${most} ${means}`.trim(),
    ),
  ])
    if (part) box.append(part);
  return box;
}

function content(one: ParameterSummary, found: Repeatability, group: string): HTMLElement[] {
  const parts: HTMLElement[] = [
    el(
      'p',
      {},
      el('strong', found.verdict === 'scatter_larger' ? { class: 'no' } : {}, labelOf(found)),
      ` ${sentence(found.text)}`,
    ),
  ];
  parts.push(numbers(found, one.unit));
  if (found.rows.length > 1) parts.push(plots(one, found));
  const made = (): HTMLElement => groupTable(found, group, unitText(one.unit));
  const few = found.rows.length <= kOpenRows;
  if (found.rows.length > 0)
    parts.push(few ? made() : details(`Table of ${countText(Math.min(kMostRows, found.rows.length))} groups`, made));
  if (found.rows.length > kMostRows)
    parts.push(text(`${countText(found.rows.length - kMostRows)} more groups are in the JSON.`, 'quiet'));
  return parts;
}

/** What was found; the sentence that follows says how large it is. */
const kLabels = {
  agrees: 'The runs agree with their errors.',
  scatter_larger: 'The runs scatter by more than their errors predict.',
  scatter_smaller: 'The runs scatter by less than their errors predict.',
};

/** A note that the agreement of only a few runs is weak evidence. */
const labelOf = (found: Repeatability): string =>
  found.verdict === 'agrees' && !found.has_enough_runs
    ? 'The runs agree with their errors, but they are few.'
    : kLabels[found.verdict];

/** group: column by which the runs are grouped. */
export function repeatabilitySection(one: ParameterSummary, group: string | null): HTMLElement {
  const title = 'Do runs repeat within their error bars?';
  const found = one.repeatability;
  const why = one.repeatability_reason ?? 'the runs of this parameter cannot be compared';
  return found
    ? section('repeatability', title, ...content(one, found, group ?? 'Group'))
    : section('repeatability', title, absent(sentence(why)));
}
