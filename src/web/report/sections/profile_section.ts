// SPDX-License-Identifier: Apache-2.0
/** Profiles of the likelihood: how the fit becomes worse when one parameter is held at another value. */

import { Chart, padded } from '../../shared/chart';
import { details, el } from '../../shared/dom';
import { modelMark } from '../../shared/marks';
import type { Parameter, ProfileCurve } from '../../shared/result_types';
import { significant } from '../../shared/rounding';
import { extent } from '../../shared/samples';
import { figure, section } from '../../shared/section';
import { table } from '../../shared/table';
import { unitText, wordsOf } from '../../shared/units';
import { rankOf, shownFit, type Report } from '../report';

function profileChart(name: string, curve: ProfileCurve, parameter: Parameter | undefined, mark: number): HTMLElement {
  const unit = parameter ? unitText(parameter.unit) : '';
  const label = `${wordsOf(name)}${unit ? ` [${unit}]` : ''}`;
  const top = Math.min(Math.max(...curve.statistic), 3 * curve.threshold);
  const sentence = `Profile of the ${wordsOf(name)}.`;
  const chart = new Chart({
    name: `profile_${name}`,
    sentence: () => sentence,
    xLabel: label,
    yLabel: () => '−2 log likelihood ratio',
    xRange: () => padded(extent([curve.value]), 0.04),
    yRange: () => [0, Math.max(1.15 * curve.threshold, 1.06 * top)],
    draw: (painter) => {
      painter.horizontal(curve.threshold, 'curve-2', [6, 4]);
      if (typeof parameter?.estimate === 'number') painter.vertical(parameter.estimate, 'rule', [2, 3]);
      painter.line(curve.value, curve.statistic, { ...modelMark(mark), dash: [] });
      painter.dots(curve.value, curve.statistic, modelMark(mark).colour, 2.5);
    },
    height: 220,
  });
  const rows = (): HTMLElement =>
    table(
      `Profile of ${wordsOf(name)}`,
      [{ head: label }, { head: '−2 log likelihood ratio', kind: 'number' }],
      curve.value.map((value, i) => [significant(value, 6), significant(curve.statistic[i], 3)]),
    );
  return el('div', {}, figure(sentence, chart.withButtons()), details('Points as a table', rows));
}

/** Null if no profile was computed. */
export function profileSection(report: Report): HTMLElement | null {
  const fit = shownFit(report);
  const profiles = fit && report.recordings[0].series?.profiles?.[fit.model];
  const entries = Object.entries(profiles ?? {}).filter(([, curve]) => curve.value.length > 1);
  if (!fit || entries.length === 0) return null;
  const grid = el('div', { class: 'pair' });
  for (const [name, curve] of entries)
    grid.append(profileChart(name, curve, fit.parameters[name], rankOf(report.result, report.shown)));
  const words = 'The dashed line is the limit of the 95 % interval. If a curve is not a parabola, the error is not symmetric.';
  return section('profiles', 'Profile likelihoods', el('p', {}, words), grid);
}
