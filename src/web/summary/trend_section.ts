// SPDX-License-Identifier: Apache-2.0
/** Whether a parameter changes from run to run. */

import { details, el, text } from '../shared/dom';
import { identifier } from '../shared/names';
import { numberText, sentence, typeset } from '../shared/prose';
import { significant } from '../shared/rounding';
import { absent, section } from '../shared/section';
import { facts, table, type Cell } from '../shared/table';
import { unitText } from '../shared/units';
import { columnLabel, TrendPlot } from './trend_plot';
import type { ParameterSummary, Trend } from './types';

function runs(one: ParameterSummary, trend: Trend): HTMLElement {
  const unit = unitText(one.unit);
  const rows = trend.points.map((point): Cell[] => [
    identifier(point.id),
    point.group === null ? '–' : identifier(point.group),
    significant(point.x, 6),
    numberText(point.text),
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
  return section(
    'trend',
    title,
    trend.text !== '' && text(sentence(trend.text)),
    facts([
      ['slope ± standard error', typeset(trend.texts.slope)],
      ['p of no slope', numberText(trend.texts.p)],
    ]),
    el(
      'div',
      {},
      new TrendPlot(one, trend).element(),
      details('Runs as a table', () => runs(one, trend)),
    ),
  );
}
