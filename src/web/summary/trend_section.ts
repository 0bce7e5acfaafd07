// SPDX-License-Identifier: Apache-2.0
/** Whether a parameter changes from run to run. */

import { details, el, text } from '../shared/dom';
import { identifier, visible } from '../shared/names';
import { sentence } from '../shared/prose';
import { plusMinus, probabilityText, significant } from '../shared/rounding';
import { absent, section } from '../shared/section';
import { facts, table, type Cell } from '../shared/table';
import { spacedUnit, unitText } from '../shared/units';
import { columnLabel, TrendPlot } from './trend_plot';
import type { ParameterSummary, Trend } from './types';

/** The unit in the denominator of a slope: "day" for days since a date, "run" for a position. */
export function perText({ column, unit }: Trend): string {
  if (column === 'position') return 'run';
  const since = /^(\w+?)s? since /.exec(unit ?? '');
  return since ? since[1] : visible(unit ?? `unit of ${column}`);
}

function runs(one: ParameterSummary, trend: Trend): HTMLElement {
  const unit = unitText(one.unit);
  const rows = trend.points.map((point): Cell[] => [
    identifier(point.id),
    point.group === null ? '–' : identifier(point.group),
    significant(point.x, 6),
    plusMinus(point.y, point.std_error),
  ]);
  const heads = [{ head: 'Run' }, { head: 'Group' }, { head: columnLabel(trend), kind: 'number' as const }];
  const box = table(
    'Runs',
    [...heads, { head: `Value ± standard error${unit && ` [${unit}]`}`, kind: 'number' }],
    rows,
  );
  box.classList.add('ids');
  return box;
}

export function trendSection(one: ParameterSummary): HTMLElement {
  const { trend } = one;
  const title = 'Trend';
  if (!trend || trend.points.length === 0)
    return section('trend', title, absent('There is no trend to show: too few runs, or too few of them with a number or a date to order them by.'));
  const slope =
    trend.slope === null
      ? '–'
      : `${plusMinus(trend.slope, trend.std_error)}${spacedUnit(one.unit)} per ${perText(trend)}`;
  return section(
    'trend',
    title,
    trend.text !== '' && text(sentence(trend.text)),
    facts([
      ['slope ± standard error', slope],
      ['p of no slope', probabilityText(trend.p)],
    ]),
    el(
      'div',
      {},
      new TrendPlot(one, trend).element(),
      details('Runs as a table', () => runs(one, trend)),
    ),
  );
}
