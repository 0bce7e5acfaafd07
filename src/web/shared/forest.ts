// SPDX-License-Identifier: Apache-2.0
/** Forest plot of a parameter: its estimate from each recording alone beside the estimate from all. */

import type { Num } from './result_types';

/** A row of the plot. A missing number is null. */
export interface ForestRow {
  kind: 'recording' | 'joint' | 'random';
  label: string;
  disagrees: boolean;
  estimate: Num;
  /** The estimate with its error. */
  text: string | null | undefined;
  interval95: [Num, Num] | null;
  /** Name of a colour, instead of the colour of its kind. */
  colour?: string;
}

const known = (x: Num | undefined): x is number => typeof x === 'number' && Number.isFinite(x);

/** Half the length of the interval; 0 without an interval. */
function reachOf({ interval95 }: ForestRow): number {
  const [low, high] = interval95 ?? [null, null];
  return known(low) && known(high) ? 0.5 * (high - low) : 0;
}

const kWide = 10; // times the median; a longer interval does not influence the range of the axis
// The axis extends beyond the outermost estimates by the larger of these two:
const kRoom = 6; // times the median of half an interval,
const kSpreads = 1.5; // times the spread of the estimates

/** Lower median of the positive values; 0 if there are none. */
function lowerMedian(values: number[]): number {
  const positive = values.filter((value) => value > 0).sort((a, b) => a - b);
  return positive[(positive.length - 1) >> 1] ?? 0;
}

/**
 * Range of the axis. It holds all estimates whose intervals are not much longer than those of the others. Long intervals
 * are cut so that the others can be seen. Null if no estimate is known.
 */
export function forestRange(rows: ForestRow[]): [number, number] | null {
  const typical = lowerMedian(rows.filter((row) => row.kind === 'recording').map(reachOf));
  const told = rows.filter((row) => known(row.estimate));
  const sharp = told.filter((row) => typical === 0 || reachOf(row) <= kWide * typical);
  const estimates = (sharp.length > 0 ? sharp : told).map((row) => row.estimate as number);
  if (estimates.length === 0) return null;
  const [low, high] = [Math.min(...estimates), Math.max(...estimates)];
  const room = Math.max(kRoom * typical, kSpreads * (high - low));
  const ends = told.flatMap((row) => [row.estimate, ...(row.interval95 ?? [])]).filter(known);
  const from = Math.max(Math.min(...ends), low - room);
  const to = Math.min(Math.max(...ends), high + room);
  const margin = 0.05 * (to - from || Math.abs(low) || 1);
  return [from - margin, to + margin];
}

/** Position of a row, as shares of the axis. `cut`: the interval is longer than drawn at this end. */
export interface Place {
  from: number;
  to: number;
  /** Null if the estimate is outside the axis. */
  at: number | null;
  cutLow: boolean;
  cutHigh: boolean;
}

/** Null for a row without an estimate. */
export function placeOf(row: ForestRow, [low, high]: readonly [number, number]): Place | null {
  if (!known(row.estimate)) return null;
  const share = (x: Num | undefined, otherwise: number): number => (known(x) ? (x - low) / (high - low) : otherwise);
  const within = (x: number): number => Math.min(1, Math.max(0, x));
  const at = share(row.estimate, 0);
  const [from, to] = [share(row.interval95?.[0], at), share(row.interval95?.[1], at)];
  return {
    from: within(from),
    to: within(to),
    at: within(at) === at ? at : null,
    cutLow: Math.min(from, at) < 0,
    cutHigh: Math.max(to, at) > 1,
  };
}

/** Labels of the rows whose intervals are longer than drawn. */
export function clipped(rows: ForestRow[], range: readonly [number, number]): string[] {
  return rows.flatMap((row) => {
    const place = placeOf(row, range);
    return place && (place.cutLow || place.cutHigh) ? [row.kind === 'recording' ? row.label : `the ${row.label}`] : [];
  });
}
