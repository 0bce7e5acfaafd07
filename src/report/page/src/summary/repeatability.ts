// SPDX-License-Identifier: Apache-2.0
/** Rows of the plots of repeatability: how much the runs of each rig scatter, and where their means are. */

import type { ForestRow } from '../forest';
import type { GroupRow, Repeatability } from './types';
import { elided } from './words';

const kMostRows = 24; // of a plot
const kLabel = 18; // characters
const kTwoSided95 = 1.96;
const kLevel = 0.05;

/** Quantiles 0.025 and 0.975 of χ² with 1, 2 ... degrees of freedom (any table of them). */
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

/** The same of any; beyond the table by E. B. Wilson & M. M. Hilferty, PNAS 17:684 (1931). */
export function chiSquare95(dof: number): [number, number] {
  if (dof <= kChiSquare.length) return kChiSquare[Math.max(1, dof) - 1];
  const quantile = (z: number): number => dof * (1 - 2 / (9 * dof) + z * Math.sqrt(2 / (9 * dof))) ** 3;
  return [quantile(-kTwoSided95), quantile(kTwoSided95)];
}

/** 95 % interval of scatter over error bars, of a ratio from that many degrees of freedom. */
export function scatterInterval(ratio: number, dof: number): [number, number] {
  const [low, high] = chiSquare95(dof);
  return [ratio * Math.sqrt(dof / high), ratio * Math.sqrt(dof / low)];
}

const kFewestToTell = 20; // degrees of freedom: with fewer the scatter may be a third off by chance

/** Whether the runs are enough to say that error bars are true. */
export const tells = ({ dof }: Repeatability): boolean => dof >= kFewestToTell;

/** Whether the runs of a group scatter otherwise than their errors say, as one of so many groups that were asked. */
export const disagrees = ({ p }: GroupRow, groups: number): boolean => p !== null && p < kLevel / Math.max(1, groups);

/** The rows to draw, in their order: of many those that agree least with their error bars. */
export function rowsToDraw(rows: GroupRow[]): GroupRow[] {
  if (rows.length <= kMostRows) return rows;
  const least = [...rows].sort((a, b) => (a.p ?? 1) - (b.p ?? 1)).slice(0, kMostRows);
  return rows.filter((row) => least.includes(row));
}

/** Scatter of each group over its error bars, and the line where it would be if these are true. */
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

/** Weighted mean of each group with its 95 % interval. */
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
