// SPDX-License-Identifier: Apache-2.0
/** Rows of the repeatability plots: scatter and mean of the runs of each rig. */

import type { ForestRow } from '../shared/forest';
import { elided } from '../shared/names';
import type { GroupRow, Repeatability } from './types';

const kMostRows = 24; // of a plot, at most
const kLabel = 18; // characters, at most
const kTwoSided95 = 1.96;
const kLevel = 0.05;

/** Quantiles 0.025 and 0.975 of χ² with 1, 2 ... 10 degrees of freedom. */
const kChiSquare: [number, number][] = [
  [0.000982, 5.024],
  [0.0506, 7.378],
  [0.2158, 9.348],
  [0.4844, 11.143],
  [0.8312, 12.833],
  [1.2373, 14.449],
  [1.6899, 16.013],
  [2.1797, 17.535],
  [2.7004, 19.023],
  [3.247, 20.483],
];

/**
 * Quantiles 0.025 and 0.975 of χ². Above 10 degrees of freedom by the approximation of E. B. Wilson & M. M. Hilferty,
 * PNAS 17:684 (1931).
 */
export function chiSquare95(dof: number): [number, number] {
  if (dof <= kChiSquare.length) return kChiSquare[Math.max(1, dof) - 1];
  const quantile = (z: number): number => dof * (1 - 2 / (9 * dof) + z * Math.sqrt(2 / (9 * dof))) ** 3;
  return [quantile(-kTwoSided95), quantile(kTwoSided95)];
}

/** 95 % confidence interval of the ratio of scatter to error bars. */
export function scatterInterval(ratio: number, dof: number): [number, number] {
  const [low, high] = chiSquare95(dof);
  return [ratio * Math.sqrt(dof / high), ratio * Math.sqrt(dof / low)];
}

const kLeastDegrees = 20; // degrees of freedom; with fewer, the scatter may be wrong by a third by chance

/** Whether there are enough runs to judge the error bars. */
export const hasEnoughRuns = ({ dof }: Repeatability): boolean => dof >= kLeastDegrees;

/** Whether the scatter of a group disagrees with its error bars, at a level of 5 % for all `groups` tests together. */
export const disagrees = ({ p }: GroupRow, groups: number): boolean => p !== null && p < kLevel / Math.max(1, groups);

/** The rows to draw, in order. If there are many, those with the smallest p. */
export function rowsToDraw(rows: GroupRow[]): GroupRow[] {
  if (rows.length <= kMostRows) return rows;
  const least = [...rows].sort((a, b) => (a.p ?? 1) - (b.p ?? 1)).slice(0, kMostRows);
  return rows.filter((row) => least.includes(row));
}

/** Ratio of scatter to error bars of each group, and a last row at the expected ratio 1. */
export function scatterRows({ rows, groups }: Repeatability): ForestRow[] {
  const drawn = rowsToDraw(rows).map((row): ForestRow => {
    const ratio = row.runs > 1 ? row.scatter_ratio : null;
    return {
      kind: 'recording',
      label: elided(row.group, kLabel),
      disagrees: disagrees(row, groups),
      estimate: ratio,
      std_error: null,
      interval95: ratio === null ? null : scatterInterval(ratio, row.runs - 1),
      z: null,
    };
  });
  const truth = { disagrees: false, estimate: 1, std_error: null, interval95: null, z: null };
  return [...drawn, { ...truth, kind: 'joint', label: 'true error bars' }];
}

/** Weighted mean of each group with its 95 % confidence interval. */
export function meanRows({ rows }: Repeatability): ForestRow[] {
  return rowsToDraw(rows).map((row): ForestRow => {
    const { weighted_mean: mean, std_error: error } = row;
    const reach = mean !== null && error !== null ? kTwoSided95 * error : null;
    return {
      kind: 'recording',
      label: elided(row.group, kLabel),
      disagrees: false,
      estimate: mean,
      std_error: error,
      interval95: mean !== null && reach !== null ? [mean - reach, mean + reach] : null,
      z: null,
    };
  });
}
