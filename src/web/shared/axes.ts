// SPDX-License-Identifier: Apache-2.0
/** Axes of the plots. */

import type uPlot from 'uplot';

import { kPlotFont } from './painter';
import { fixed, significant } from './rounding';
import { colour } from './theme';

const kFont = `12px ${kPlotFont}`;
const kTitleFont = `13px ${kPlotFont}`;
const kCharacter = 6.9; // px, width of a digit of 12 px text

/** Labels of ticks at intervals of `step`, all with the same number of decimals. */
export function tickTexts(ticks: readonly number[], step: number): string[] {
  const largest = Math.max(...ticks.map(Math.abs));
  if (largest !== 0 && (largest < 1e-4 || largest >= 1e6)) return ticks.map((tick) => significant(tick, 4).replace(' × ', '×'));
  const decimals = Math.max(0, Math.min(12, -Math.floor(Math.log10(step) + 1e-9)));
  return ticks.map((tick) => fixed(tick, decimals));
}

/** Ticks of a logarithmic axis: 1, 2 and 5 times powers of ten in [low, high]. */
export function logTicks(low: number, high: number): number[] {
  const ticks: number[] = [];
  if (!(low > 0 && high < Infinity)) return ticks;
  for (let exponent = Math.floor(Math.log10(low)); exponent <= Math.log10(high); ++exponent) {
    for (const digit of [1, 2, 5]) ticks.push(digit * 10 ** exponent);
  }
  return ticks.filter((tick) => tick >= low * 0.999 && tick <= high * 1.001);
}

/** Allowed intervals between ticks: 1, 2 or 5 times a power of ten. */
const kSteps = Array.from({ length: 40 }, (_unused, i) => i - 20).flatMap((power) =>
  [1, 2, 5].map((digit) => Number(`${digit}e${power}`)),
);

const common = (): Partial<uPlot.Axis> => ({
  font: kFont,
  labelFont: kTitleFont,
  labelSize: 20,
  labelGap: 2,
  incrs: kSteps,
  stroke: () => colour('ink'),
  grid: { stroke: () => colour('grid'), width: 1 },
  ticks: { stroke: () => colour('grid'), width: 1, size: 4 },
});

const widest = (texts: readonly string[] | null): number => Math.max(3, ...(texts ?? []).map((text) => text.length));

/** Width of the widest tick label on an axis, px. */
function widestTick(low: number, high: number): number {
  const ticks = roundTicks(low, high);
  return ticks.length < 2 ? 0 : kCharacter * widest(tickTexts(ticks, ticks[1] - ticks[0]));
}

export const xAxis = (label: string): uPlot.Axis => ({
  ...common(),
  ...(label === '' ? { labelSize: 0 } : { label }),
  size: 30,
  space: (plot, _axis, low, high) => Math.max(plot.width < 480 ? 52 : 70, widestTick(low, high) + 16),
  values: (_plot, ticks, _axis, _space, step) => tickTexts(ticks, step),
});

export interface YAxisOptions {
  log?: boolean;
  right?: boolean;
  factor?: number;
  /** Width of the tick labels, px; default: as needed. */
  room?: number;
}

/**
 * The vertical axis. `factor` converts the unit of the scale to the unit of the label, for a second axis on the right.
 */
export function yAxis(label: () => string, options: YAxisOptions = {}): uPlot.Axis {
  const factor = options.factor ?? 1;
  const axis: uPlot.Axis = {
    ...common(),
    scale: 'y',
    label: label(),
    side: options.right ? 1 : 3,
    size: (_plot, texts) => options.room ?? Math.ceil(widest(texts) * kCharacter + 12),
    space: (plot) => (plot.height < 220 ? 20 : 34),
    values: (_plot, ticks, _axis, _space, step) =>
      tickTexts(
        ticks.map((tick) => factor * tick),
        factor * step,
      ),
  };
  if (options.right) axis.grid = { show: false };
  if (options.right)
    axis.splits = (_plot, _axis, low, high) => roundTicks(factor * low, factor * high).map((t) => t / factor);
  if (options.right) axis.values = (_plot, ticks) => rightTexts(ticks.map((tick) => factor * tick));
  if (options.log) axis.splits = (_plot, _axis, low, high) => logTicks(low, high);
  if (options.log) axis.filter = (_plot, ticks) => ticks;
  if (options.log) axis.values = (_plot, ticks) => ticks.map((tick) => (tick === null ? '' : significant(tick, 2)));
  return axis;
}

/** About five round numbers in [low, high]. */
export function roundTicks(low: number, high: number): number[] {
  const rough = (high - low) / 5;
  const power = 10 ** Math.floor(Math.log10(rough));
  const step = [1, 2, 5, 10].map((digit) => digit * power).find((candidate) => candidate >= rough) ?? power;
  const ticks: number[] = [];
  for (let i = Math.ceil(low / step - 1e-9); i * step <= high * (1 + 1e-12) + 1e-300; ++i) ticks.push(i * step);
  return ticks;
}

function rightTexts(ticks: number[]): string[] {
  const step = ticks.length > 1 ? ticks[1] - ticks[0] : 1;
  return tickTexts(ticks, step);
}
