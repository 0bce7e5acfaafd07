// SPDX-License-Identifier: Apache-2.0
/** Comparison of the models. */

import { el, text } from '../../shared/dom';
import { modelMark, swatch } from '../../shared/marks';
import { sentence, typeset } from '../../shared/prose';
import type { Comparison, ComparisonRow, Num, Prediction } from '../../shared/result_types';
import { fixed, probabilityText, significant } from '../../shared/rounding';
import { section } from '../../shared/section';
import { table, type Cell, type Column } from '../../shared/table';
import { withUnit, unitText } from '../../shared/units';
import { rankOf, type Report } from '../report';

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
  const fits = row.lack_of_fit ? 'lack of fit' : row.is_compared ? 'yes' : 'not compared';
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
    { head: 'Model' },
    { head: 'Parameters', kind: number },
    { head: `rms [${unitText(unit)}]`, kind: number },
    { head: 'ΔBIC', kind: number },
    { head: 'AICc weight', kind: number },
    { head: `Left-out samples [${unitText(unit)}]`, kind: number },
    { head: `Later motion [${unitText(unit)}]`, kind: number },
    { head: 'Lag-1', kind: number },
    { head: 'Only noise left' },
  ];
  const marked = comparison.rows.findIndex((row) => row.model === comparison.recommended);
  return table(
    'Models, the recommended one marked',
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
    { head: 'Its distribution if the simpler holds' },
  ];
  const rows = tests.map((test): Cell[] => [
    `${test.simpler} → ${test.richer}`,
    test.p === null ? [el('span', {}, '–'), el('small', {}, typeset(test.reason ?? ''))] : probabilityText(test.p),
    test.added.join(', '),
    significant(test.statistic, 4),
    test.null,
  ]);
  return table('Likelihood-ratio tests of nested models', columns, rows);
}

/** Why a model has no information criteria. */
const unjudged = ({ rows }: Comparison): HTMLElement[] =>
  rows
    .filter((row) => !row.is_compared && row.reason !== undefined)
    .map((row) => text(sentence(`${row.model} is not compared: ${row.reason?.replace(/_/g, ' ')}`), 'quiet'));

const kMeaning =
  'Left-out samples: blocks predicted by a fit to the others. Later motion: the end predicted from the beginning. ' +
  'In brackets the same in units of its expected size, about 1 for a model that holds.';

/** Null if only one model was fitted. */
export function comparisonSection(report: Report): HTMLElement | null {
  const { comparison } = report.result;
  if (!comparison) return null;
  const verdict =
    comparison.recommended === null ? 'No model is recommended' : `Recommended: ${comparison.recommended}`;
  return section(
    'comparison',
    'Models compared',
    el('p', {}, el('strong', {}, `${verdict}. `), sentence(comparison.reason)),
    modelTable(report, comparison),
    ...unjudged(comparison),
    text(kMeaning, 'quiet'),
    testTable(comparison),
    text(sentence(comparison.criterion_reason), 'quiet'),
  );
}
