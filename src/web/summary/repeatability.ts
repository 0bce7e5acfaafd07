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
const forestRow = (
  { group }: GroupRow,
  disagrees: boolean,
  estimate: GroupRow['p'],
  text: string,
  interval95: [number, number],
): ForestRow => ({ kind: 'recording', label: elided(group, kLabel), disagrees, estimate, text, interval95 });

/** Ratio of scatter to error bars of each group, and a last row at the expected ratio 1. */
export const scatterRows = ({ rows }: Repeatability): ForestRow[] => [
  ...rowsToDraw(rows).map((row) =>
    forestRow(row, row.disagrees, row.scatter_ratio, row.texts.scatter_ratio, row.scatter_interval95),
  ),
  { kind: 'joint', label: 'true error bars', disagrees: false, estimate: 1, text: '1', interval95: null },
];

/** Weighted mean of each group with its 95 % confidence interval. */
export const meanRows = ({ rows }: Repeatability): ForestRow[] =>
  rowsToDraw(rows).map((row) => forestRow(row, false, row.weighted_mean, row.texts.weighted_mean, row.interval95));
