// SPDX-License-Identifier: Apache-2.0
import { extent } from '../shared/samples';
import { moments } from './autocorrelation';

/** Bars of equal width from `start`. The density integrates to the share of the values that are within the bars. */
export interface Histogram {
  start: number;
  width: number;
  counts: number[];
  density: number[];
  mean: number;
  deviation: number;
  count: number;
}

const kFewestBars = 7;
const kMostBars = 61;

/** Bars about 3.5 s N^(-1/3) wide, s the standard deviation (D. W. Scott, Biometrika 66:605, 1979). */
export function histogram(values: Float64Array): Histogram | null {
  const range = extent([values]);
  const { mean, deviation, count } = moments(values);
  if (!range || count < 2 || !(deviation > 0)) return null;
  const span = range[1] - range[0];
  const width = Math.min(Math.max((3.5 * deviation) / Math.cbrt(count), span / kMostBars), span / kFewestBars);
  const start = Math.floor(range[0] / width) * width;
  const bars = Math.floor((range[1] - start) / width) + 1;
  const counts = new Array<number>(bars).fill(0);
  for (const value of values) {
    if (Number.isFinite(value)) ++counts[Math.min(bars - 1, Math.max(0, Math.floor((value - start) / width)))];
  }
  return { start, width, counts, density: counts.map((n) => n / (count * width)), mean, deviation, count };
}

/** Density of the normal distribution. */
export function normalDensity(x: number, mean: number, deviation: number): number {
  const z = (x - mean) / deviation;
  return Math.exp(-0.5 * z * z) / (deviation * Math.sqrt(2 * Math.PI));
}
