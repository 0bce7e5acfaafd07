// SPDX-License-Identifier: Apache-2.0
/** Whether the residuals are noise: autocorrelation, histogram and tests. */

import { Chart, padded } from '../../shared/chart';
import { details, el } from '../../shared/dom';
import { significant } from '../../shared/rounding';
import { absent, figure, section } from '../../shared/section';
import { table } from '../../shared/table';
import { inShownUnit, shownUnit } from '../../shared/units';
import { autocorrelation } from '../autocorrelation';
import { histogram, normalDensity, type Histogram } from '../histogram';
import { shownFitOf, type OneRecording } from '../report';
import { told } from '../told';

const kLags = 100;
const kNormal95 = 1.96;

function autocorrelationPart(residual: Float64Array): HTMLElement {
  const { r, used } = autocorrelation(residual, kLags);
  if (r.length < 2) return absent('The residuals do not vary, so they have no autocorrelation.');
  const limit = kNormal95 / Math.sqrt(used);
  const lags = r.map((_value, k) => k);
  const beyond = r.slice(1).filter((value) => Math.abs(value) > limit).length;
  const low = Math.min(-2 * limit, ...r) * 1.15;
  const share = `${beyond} of ${r.length - 1} lags are outside ±${significant(limit, 2)}; white noise has 95 % inside`;
  const chart = new Chart({
    name: 'autocorrelation',
    sentence: () => `Autocorrelation of the residuals: ${share}.`,
    xLabel: 'lag [samples]',
    yLabel: () => 'autocorrelation',
    xRange: () => [0, r.length],
    yRange: () => [low, Math.max(3 * limit, ...r.slice(1)) * 1.15],
    draw: (painter) => {
      painter.band(-limit, limit, 'band');
      painter.horizontal(0, 'rule');
      painter.bars(
        lags.slice(1).map((k) => k - 0.35),
        lags.slice(1).map((k) => k + 0.35),
        r.slice(1),
        'curve-1',
      );
    },
    height: 240,
  });
  const rows = (): HTMLElement =>
    table(
      'Autocorrelation by lag',
      [{ head: 'Lag' }, { head: 'r', kind: 'number' }],
      r.slice(1, 21).map((value, i) => [String(i + 1), significant(value, 3)]),
    );
  return el('div', {}, figure(`Autocorrelation: ${share}.`, chart.withButtons()), details('First lags as a table', rows));
}

function normalCurve(bars: Histogram): { x: number[]; y: number[] } {
  const [low, high] = [bars.start, bars.start + bars.width * bars.counts.length];
  const x = Array.from({ length: 161 }, (_unused, i) => low + ((high - low) * i) / 160);
  return { x, y: x.map((value) => normalDensity(value, bars.mean, bars.deviation)) };
}

function histogramPart(residual: Float64Array, ownUnit: string): HTMLElement {
  const { unit } = shownUnit(ownUnit);
  const bars = histogram(inShownUnit(residual, ownUnit));
  if (!bars) return absent('The residuals do not vary, so they have no distribution to draw.');
  const left = bars.counts.map((_count, i) => bars.start + i * bars.width);
  const right = left.map((x) => x + bars.width);
  const curve = normalCurve(bars);
  const sentence =
    `Residuals from ${significant(left[0], 2)} to ${significant(right[right.length - 1], 2)} ${unit}, ` +
    `standard deviation ${significant(bars.deviation, 3)} ${unit}, with the normal curve of that width`;
  const chart = new Chart({
    name: 'histogram',
    sentence: () => `Histogram. ${sentence}.`,
    xLabel: `residual [${unit}]`,
    yLabel: () => `density [1/${unit}]`,
    xRange: () => padded([left[0], right[right.length - 1]], 0.02),
    yRange: () => [0, 1.08 * Math.max(...bars.density, ...curve.y)],
    draw: (painter) => {
      painter.bars(left, right, bars.density, 'bar');
      painter.line(curve.x, curve.y, { colour: 'curve-2', dash: [7, 4], width: 1.75 });
    },
    height: 240,
  });
  const rows = (): HTMLElement =>
    table(
      'Residuals by size',
      [{ head: `From [${unit}]` }, { head: 'To', kind: 'number' }, { head: 'Samples', kind: 'number' }],
      bars.counts.map((count, i) => [significant(left[i], 3), significant(right[i], 3), String(count)]),
    );
  return el('div', {}, figure(`${sentence} (dashed).`, chart.withButtons()), details('Bars as a table', rows));
}

export const kResidualsTitle = 'Are the residuals noise?';

export function residualSection(one: OneRecording): HTMLElement {
  const fit = shownFitOf(one);
  const { samples } = one;
  if (!fit) return section('residuals', kResidualsTitle, absent('Without a fit there are no residuals.'));
  const residual = samples?.models.get(fit.model)?.residual;
  const plots =
    residual && samples
      ? el('div', { class: 'pair' }, autocorrelationPart(residual), histogramPart(residual, samples.unit))
      : absent('The residuals are not part of this report.');
  return section('residuals', kResidualsTitle, plots, ...told(one.report, 'residuals', kResidualsTitle));
}
