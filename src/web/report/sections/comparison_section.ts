// SPDX-License-Identifier: Apache-2.0
/** Comparison of the models. */

import { warningList } from '../../shared/banner';
import { el, text } from '../../shared/dom';
import { modelMark, swatch } from '../../shared/marks';
import { sentence, typeset } from '../../shared/prose';
import type { Comparison, ComparisonRow, Num, Prediction } from '../../shared/result_types';
import { fixed, probabilityText, significant } from '../../shared/rounding';
import { section } from '../../shared/section';
import { table, type Cell, type Column } from '../../shared/table';
import { withUnit, unitText } from '../../shared/units';
import { recommendation } from '../answer';
import { otherWarnings, rankOf, shownFit, type Report } from '../report';

const difference = (value: Num): string => (value === null ? '–' : fixed(value, 1));

/** "0.0036 (1.01 σ)" */
function predictionText(prediction: Prediction | null): Cell {
  if (!prediction || prediction.samples === 0) return '–';
  const rms = withUnit(prediction, 'rms');
  const size = rms ? significant(rms.value, 3) : '–';
  return [size, prediction.standardized !== null && el('small', {}, `(${significant(prediction.standardized, 3)} σ)`)];
}

function modelRow(report: Report, row: ComparisonRow): Cell[] {
  const i = report.result.fits.findIndex((fit) => fit.model === row.model);
  const rms = withUnit(row, 'rms_residual');
  const fits = row.lack_of_fit ? 'no' : row.is_compared ? 'yes' : 'not compared';
  return [
    [i >= 0 && swatch(modelMark(rankOf(report.result, i))), row.model],
    row.is_compared ? String(row.parameters) : '–',
    rms ? significant(rms.value, 3) : '–',
    difference(row.delta_bic),
    row.akaike_weight === null ? '–' : row.akaike_weight < 1e-4 ? '< 0.0001' : fixed(row.akaike_weight, 4),
    predictionText(row.cross_validation),
    predictionText(row.forward_prediction),
    significant(row.lag1_correlation, 2),
    fits,
  ];
}

function modelTable(report: Report, comparison: Comparison): HTMLElement {
  const unit = withUnit(comparison.rows[0], 'rms_residual')?.unit ?? 'rad';
  const number = 'number' as const;
  const columns: Column[] = [
    { head: 'Law' },
    { head: 'Parameters', kind: number },
    { head: `rms [${unitText(unit)}]`, kind: number },
    { head: 'ΔBIC', kind: number },
    { head: 'AICc weight', kind: number },
    { head: `Left-out samples [${unitText(unit)}]`, kind: number },
    { head: `Later motion [${unitText(unit)}]`, kind: number },
    { head: 'Lag-1 correlation', kind: number },
    { head: 'Residuals are noise' },
  ];
  const marked = comparison.rows.findIndex((row) => row.model === comparison.recommended);
  return table(
    'Laws; the recommended one is marked',
    columns,
    comparison.rows.map((row) => modelRow(report, row)),
    [marked],
  );
}

function testTable({ tests }: Comparison): HTMLElement | null {
  if (tests.length === 0) return null;
  const columns: Column[] = [
    { head: 'Simpler → richer' },
    { head: 'p', kind: 'number' },
    { head: 'Adds' },
    { head: 'Likelihood ratio', kind: 'number' },
    { head: 'Distribution if the simpler law holds' },
  ];
  const rows = tests.map((test): Cell[] => [
    `${test.simpler} → ${test.richer}`,
    test.p === null ? [el('span', {}, '–'), el('small', {}, typeset(test.reason ?? ''))] : probabilityText(test.p),
    test.added.join(', '),
    significant(test.statistic, 4),
    test.null,
  ]);
  return el('div', { class: 'tests' }, table('Likelihood-ratio tests of nested laws', columns, rows));
}

/** Why a model has no information criteria. */
const unjudged = ({ rows }: Comparison): HTMLElement[] =>
  rows
    .filter((row) => !row.is_compared && row.reason !== undefined)
    .map((row) => text(sentence(`${row.model} is not compared: ${row.reason?.replace(/_/g, ' ')}`), 'quiet'));

const kMeaning =
  'Left-out samples: a fit to the other samples predicts them. Later motion: a fit to the beginning predicts the end. ' +
  'Both columns are root mean square errors. In brackets: the same divided by the expected error; it is about 1 for a law that holds.';

/** Warnings of the laws that are not shown. */
function warningsOfOthers(report: Report): HTMLElement | null {
  const others = otherWarnings(report.result, shownFit(report)?.model ?? null);
  if (others.length === 0) return null;
  const parts = others.map(({ model, warnings }) => el('div', {}, el('h4', {}, model), warningList(warnings)));
  return el('div', { class: 'other-warnings' }, el('h3', {}, 'Warnings of the other laws'), ...parts);
}

/** Null if only one model was fitted. */
export function comparisonSection(report: Report): HTMLElement | null {
  const { comparison } = report.result;
  if (!comparison) return null;
  return section(
    'comparison',
    'Laws compared',
    recommendation(comparison, comparison.recommended),
    modelTable(report, comparison),
    ...unjudged(comparison),
    text(kMeaning, 'quiet'),
    warningsOfOthers(report),
    testTable(comparison),
    text(sentence(comparison.criterion_reason), 'quiet'),
  );
}
