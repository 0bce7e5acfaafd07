// SPDX-License-Identifier: Apache-2.0
/** The points of a trend by group. */

import { extent } from '../shared/samples';
import type { Trend } from './types';

const kMostGroups = 6; // with a colour of their own

/** Runs of one group, or all runs if there are too many groups for different colours. */
export interface TrendGroup {
  name: string | null;
  x: number[];
  y: number[];
  /** NaN if there is none. */
  error: number[];
  /** Median of the run's group with the slope removed, at the x of the middle run. */
  centre: number[];
  /** Value ± standard error. */
  texts: string[];
  ids: string[];
  groups: (string | null)[];
}

export function median(values: readonly number[]): number {
  const sorted = values.filter(Number.isFinite).sort((a, b) => a - b);
  if (sorted.length === 0) return NaN;
  return 0.5 * (sorted[(sorted.length - 1) >> 1] + sorted[sorted.length >> 1]);
}

/** Median x of the runs. */
export const middle = ({ points }: Trend): number => median(points.map(({ x }) => x)) || 0;

/** Height of the trend line of each group at the middle x, so that half of its runs are above the line. */
function centres(trend: Trend): Map<string | null, number> {
  const { points, slope } = trend;
  const origin = middle(trend);
  const values = new Map<string | null, number[]>();
  for (const { x, y, group } of points) {
    if (y === null) continue;
    const list = values.get(group) ?? [];
    list.push(y - (slope ?? 0) * (x - origin));
    values.set(group, list);
  }
  return new Map([...values].map(([group, list]) => [group, median(list)]));
}

/** The groups in order of their first run, each sorted by x. Runs without a value are omitted. */
export function trendGroups(trend: Trend): TrendGroup[] {
  const lines = centres(trend);
  const apart = lines.size <= kMostGroups;
  const found = new Map<string | null, TrendGroup>();
  for (const { x, y, std_error: error, text, id, group } of [...trend.points].sort((a, b) => a.x - b.x)) {
    if (y === null) continue;
    const name = apart ? group : null;
    const made = found.get(name) ?? { name, x: [], y: [], error: [], centre: [], texts: [], ids: [], groups: [] };
    found.set(name, made);
    made.x.push(x);
    made.y.push(y);
    made.error.push(error ?? NaN);
    made.centre.push(lines.get(group) ?? NaN);
    made.texts.push(text);
    made.ids.push(id);
    made.groups.push(group);
  }
  return [...lines.keys()]
    .map((group) => found.get(apart ? group : null))
    .filter((one, i, all): one is TrendGroup => one !== undefined && all.indexOf(one) === i);
}

/** Number of groups. */
export const groupCount = ({ points }: Trend): number => new Set(points.map(({ group }) => group)).size;

/** Indices [first, end) of the runs between from and to. */
export function within({ x }: TrendGroup, from: number, to: number): [number, number] {
  const first = x.findIndex((at) => at >= from);
  if (first < 0) return [0, 0];
  const end = x.findIndex((at) => at > to);
  return [first, end < 0 ? x.length : end];
}

/** Range of all x; a range of nonzero width for a single x. */
export function xRange(groups: TrendGroup[]): [number, number] {
  const [low, high] = extent(groups.map(({ x }) => x)) ?? [0, 1];
  const room = 0.02 * (high - low) || 0.5;
  return [low - room, high + room];
}

/** Index of the run nearest to x; -1 without runs. */
export function nearest({ x }: TrendGroup, at: number): number {
  let best = -1;
  x.forEach((value, i) => {
    if (best < 0 || Math.abs(value - at) < Math.abs(x[best] - at)) best = i;
  });
  return best;
}
