// SPDX-License-Identifier: Apache-2.0
/** Distribution of the estimates of one parameter over the runs. */

import { tickTexts } from '../shared/axes';
import { Chart, padded } from '../shared/chart';
import { details, el } from '../shared/dom';
import { swatch, type Mark } from '../shared/marks';
import { numberText } from '../shared/prose';
import { absent, figure, section } from '../shared/section';
import { facts, table, type Cell } from '../shared/table';
import { spacedUnit, unitText, wordsOf } from '../shared/units';
import type { Counts, ParameterSummary } from './types';
import { counted, countText, withUnitOf } from './words';

const kLeastTop = 4; // runs, so that the ticks are integers
const kReach = 1.5; // the axis is extended by at most this many widths of the histogram, to show the error

const kMedian: Mark = { colour: 'curve-2', dash: [7, 4], width: 1.75 };
const kQuartiles: Mark = { colour: 'curve-1', dash: [], width: 6 };
const kError: Mark = { colour: 'curve-2', dash: [], width: 2.5 };

/** Left ends of the bars and their width. */
export function barsOf({ from, to, counts }: Counts): { left: number[]; width: number } {
  const width = (to - from) / Math.max(1, counts.length);
  return { left: counts.map((_count, i) => from + i * width), width };
}

/** The runs that are not drawn, in words. */
function beyond({ below, above }: Counts): string {
  if (!below && !above) return '';
  const parts = [below ? `${countText(below)} below` : '', above ? `${countText(above)} above` : ''].filter(
    (part) => part !== '',
  );
  return ` ${parts.join(' and ')} the ends ${below + above === 1 ? 'is' : 'are'} not drawn.`;
}

/** The bars, and the estimated standard error about the median. */
export function rangeOf({ median, median_std_error: error }: ParameterSummary, { from, to }: Counts): [number, number] {
  if (median === null || error === null) return [from, to];
  const most = kReach * (to - from);
  return [Math.max(from - most, Math.min(from, median - error)), Math.min(to + most, Math.max(to, median + error))];
}

function chartOf(one: ParameterSummary, bars: Counts, sentence: string): Chart {
  const { left, width } = barsOf(bars);
  const top = 1.22 * Math.max(kLeastTop, ...bars.counts);
  const { median, median_std_error: error, lower_quartile: lower, upper_quartile: upper } = one;
  const unit = unitText(one.unit);
  return new Chart({
    sentence: () => sentence,
    xLabel: `${wordsOf(one.name)}${unit && ` [${unit}]`}`,
    yLabel: () => 'runs',
    xRange: () => padded(rangeOf(one, bars), 0.02),
    yRange: () => [0, top],
    draw: (painter) => {
      painter.bars(
        left,
        left.map((x) => x + (width || 1)),
        bars.counts,
        'bar',
      );
      if (lower !== null && upper !== null) painter.line([lower, upper], [0.9 * top, 0.9 * top], kQuartiles);
      if (median === null) return;
      painter.line([median, median], [0, top], kMedian);
      if (error === null) return;
      painter.line([median - error, median + error], [0.96 * top, 0.96 * top], kError);
      painter.dots([median], [0.96 * top], kError.colour, 3.5);
    },
    height: 260,
  });
}

function legend({ median_std_error: error, lower_quartile: lower }: ParameterSummary): HTMLElement {
  const list = el('ul', { class: 'legend' }, el('li', {}, swatch(kMedian), 'median'));
  if (error !== null) list.append(el('li', {}, swatch(kError), 'quoted error of one run, ±'));
  if (lower !== null) list.append(el('li', {}, swatch(kQuartiles), 'middle half of the runs'));
  return list;
}

function histogramPart(one: ParameterSummary, bars: Counts): HTMLElement {
  const { left, width } = barsOf(bars);
  const ends = tickTexts([...left, bars.to], width / 10);
  const range = `${ends[0]} to ${ends[ends.length - 1]}${spacedUnit(one.unit)}`;
  const caption = `${counted(one.runs, 'run')}, ${wordsOf(one.name)} from ${range}.${beyond(bars)}`;
  const chart = chartOf(one, bars, `Histogram: ${caption} Median ${withUnitOf(one.texts.median, one.unit)}.`);
  const unit = unitText(one.unit);
  const rows = (): HTMLElement =>
    table(
      'Runs by value',
      [{ head: `From${unit && ` [${unit}]`}` }, { head: 'To', kind: 'number' }, { head: 'Runs', kind: 'number' }],
      bars.counts.map((count, i) => [ends[i], ends[i + 1], countText(count)]),
    );
  return el('div', {}, figure(caption, chart.host, legend(one)), details('Bars as a table', rows));
}

function numbers({ texts, unit }: ParameterSummary): HTMLElement {
  const between = (from: string, to: string): Cell => `${numberText(from)} to ${withUnitOf(to, unit)}`;
  const rows: [string, Cell][] = [
    ['median', withUnitOf(texts.median, unit)],
    ['mean', withUnitOf(texts.mean, unit)],
    ['middle half', between(texts.lower_quartile, texts.upper_quartile)],
    ['all', between(texts.minimum, texts.maximum)],
    ['standard deviation over all runs', texts.std_dev === '-' ? 'one run has none' : withUnitOf(texts.std_dev, unit)],
    ['quoted error, median', withUnitOf(texts.median_std_error, unit)],
  ];
  return facts(rows);
}

export function distributionSection(one: ParameterSummary): HTMLElement {
  const bars = one.histogram;
  return section(
    'distribution',
    'Distribution',
    numbers(one),
    bars && bars.counts.length > 0 && bars.to > bars.from
      ? histogramPart(one, bars)
      : absent(
          one.runs === 1
            ? 'One run has no spread.'
            : 'The values do not vary, so they have no distribution to draw.',
        ),
  );
}
