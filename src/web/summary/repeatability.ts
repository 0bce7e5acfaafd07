// SPDX-License-Identifier: Apache-2.0
/** Rows of the repeatability plots: scatter and mean of the runs of each rig. */

import type { ForestRow } from '../shared/forest';
import { elided } from '../shared/names';
import type { GroupRow, Repeatability } from './types';

const kMostRows = 24; // of a plot, at most
const kLabel = 18; // characters, at most

/** The rows to draw, in order. If there are many, those with the smallest p. */
export function rowsToDraw(rows: GroupRow[]): GroupRow[] {
  if (rows.length <= kMostRows) return rows;
  const least = [...rows].sort((a, b) => (a.p ?? 1) - (b.p ?? 1)).slice(0, kMostRows);
  return rows.filter((row) => least.includes(row));
}

/** A row of a plot with one group of runs. */
const forestRow = (row: GroupRow, estimate: GroupRow['p'], interval95: [number, number]): ForestRow => ({
  kind: 'recording',
  label: elided(row.group, kLabel),
  disagrees: false,
  estimate,
  std_error: null,
  interval95,
  z: null,
});

/** Ratio of scatter to error bars of each group, and a last row at the expected ratio 1. */
export function scatterRows({ rows }: Repeatability): ForestRow[] {
  const drawn = rowsToDraw(rows).map((row) => ({
    ...forestRow(row, row.scatter_ratio, row.scatter_interval95),
    disagrees: row.disagrees,
  }));
  const truth = { disagrees: false, estimate: 1, std_error: null, interval95: null, z: null };
  return [...drawn, { ...truth, kind: 'joint', label: 'true error bars' }];
}

/** Weighted mean of each group with its 95 % confidence interval. */
export const meanRows = ({ rows }: Repeatability): ForestRow[] =>
  rowsToDraw(rows).map((row) => ({ ...forestRow(row, row.weighted_mean, row.interval95), std_error: row.std_error }));
