// SPDX-License-Identifier: Apache-2.0
/** Do the recordings of a joint fit agree? */

import { el, symbolElement, text } from '../../shared/dom';
import { type ForestRow } from '../../shared/forest';
import { clippedWords, forestPlot, forestSentence, savedForest } from '../../shared/forest_plot';
import { capital, sentence } from '../../shared/prose';
import type { Homogeneity, Parameter, SharedAgreement } from '../../shared/result_types';
import { fixed, intervalText, plusMinus, probabilityText, significant } from '../../shared/rounding';
import { absent, figure, section } from '../../shared/section';
import { table, type Cell, type Column } from '../../shared/table';
import { spacedUnit, symbolOf, unitText, wordsOf } from '../../shared/units';
import { shownFit, type Report } from '../report';
import { disagreement } from './disagreement';
import { forestRows } from './forest_rows';

const number = 'number' as const;

/** "χ² = 14.8 with 12 degrees of freedom, p = 0.25." */
function testText({ statistic, dof, p }: SharedAgreement): string {
  const small = probabilityText(p);
  const freedom = `${dof} degree${dof === 1 ? '' : 's'} of freedom`;
  return `χ² = ${significant(statistic, 3)} with ${freedom}, p ${small.startsWith('<') ? small : `= ${small}`}.`;
}

function scatterText({ random_effects: scatter, unit }: SharedAgreement): string {
  const [low, high] = (scatter.between_interval95 ?? [null, null]).map((end) => significant(end, 2));
  const between = `${significant(scatter.between_std_dev, 2)}${spacedUnit(unit)}`;
  return `The standard deviation between recordings is ${between} (95 %: ${low} to ${high}).`;
}

function rowCells(row: ForestRow): Cell[] {
  const { label, disagrees, estimate, std_error: error, interval95, z } = row;
  const odd = disagrees && el('small', { class: 'no' }, 'disagrees');
  return [
    [label, odd],
    estimate === null ? 'not determined' : plusMinus(estimate, error),
    z === null ? '–' : fixed(z, 1),
    intervalText(interval95, error),
  ];
}

function numbers(name: string, unit: string, rows: ForestRow[]): HTMLElement {
  const written = unitText(unit);
  const columns: Column[] = [
    { head: 'From' },
    { head: 'Value ± standard error', kind: number },
    { head: 'z', kind: number },
    { head: '95 % interval', kind: number },
  ];
  const caption = `${wordsOf(name)}${written === '' ? '' : ` [${written}]`} by recording`;
  return table(capital(caption), columns, rows.map(rowCells));
}

function parameterPart(homogeneity: Homogeneity, name: string, joint: Parameter | undefined): HTMLElement {
  const agreement = homogeneity.parameters[name];
  const rows = forestRows(homogeneity, name, joint);
  const told = forestSentence(wordsOf(name), unitText(agreement.unit), rows);
  const plot = forestPlot(told, rows);
  const words = [testText(agreement), scatterText(agreement), clippedWords(rows)].filter((part) => part !== '');
  const part = el('div', { class: 'pair agree', 'data-forest': name });
  part.append(
    plot ? figure(words.join(' '), savedForest(plot, `${name}_by_recording`, told, rows)) : absent('No recording determines this parameter on its own.'),
    numbers(name, agreement.unit, rows),
  );
  const symbol = symbolOf(name, agreement.unit);
  const heading = el('h3', {}, capital(wordsOf(name)), symbol !== null && ' ', symbol !== null && symbolElement(symbol));
  return el('div', {}, heading, part);
}

/** How parameters change with the amplitude of the recordings; null if this was not tested. */
function amplitudeTable({ amplitude_dependence: list }: Homogeneity): HTMLElement | null {
  if (list.length === 0) return null;
  const columns: Column[] = [
    { head: 'Parameter' },
    { head: 'Slope on amplitude²', kind: number },
    { head: 'Change from smallest to largest swings', kind: number },
    { head: 'p of no slope', kind: number },
    { head: 'p of agreement after that', kind: number },
  ];
  const rows = list.map((one): Cell[] => [
    wordsOf(one.parameter),
    plusMinus(one.slope, one.std_error) + spacedUnit(one.unit.replace(/^1 \/ /, '1/')),
    one.span === null ? '–' : `${significant(100 * one.span, 2)} %`,
    probabilityText(one.p),
    probabilityText(one.p_of_remainder),
  ]);
  return table('Do they change with the amplitude of the recordings?', columns, rows);
}

/** Whether the recordings agree, in one line. */
function summary(homogeneity: Homogeneity): HTMLElement {
  const { agrees, verdict } = homogeneity;
  const label =
    agrees === null ? 'Not known.' : agrees ? 'They agree.' : `${disagreement(homogeneity) ?? 'They do not agree'}.`;
  return el('p', { class: 'agreement' }, el('strong', agrees === false ? { class: 'no' } : {}, label), ` ${sentence(verdict)}`);
}

const kMeaning =
  'The plots show each recording alone with its 95 % interval, the joint fit (dashed line), and the random-effects mean. ' +
  'The error of that mean includes the scatter between recordings. z is the difference between a recording and the ' +
  'others in standard errors.';

export function agreementSection(report: Report): HTMLElement {
  const title = 'Do the recordings agree?';
  const fit = shownFit(report);
  const homogeneity = fit?.homogeneity;
  if (!fit || !homogeneity) return section('agreement', title, absent('Without a fit there is nothing to compare.'));
  const names = Object.keys(homogeneity.parameters);
  return section(
    'agreement',
    title,
    summary(homogeneity),
    names.length > 0
      ? text(kMeaning, 'quiet')
      : absent(sentence(homogeneity.reason ?? 'no parameter can be compared between the recordings')),
    ...names.map((name) => parameterPart(homogeneity, name, fit.parameters[name])),
    amplitudeTable(homogeneity),
  );
}
