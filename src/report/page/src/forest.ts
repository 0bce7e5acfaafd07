// SPDX-License-Identifier: Apache-2.0
/** Forest plot of a shared parameter: what each recording says alone beside what all say together. */

import type { JointFit, SharedAgreement } from './joint_types';
import type { Num } from './types';

const kTwoSided95 = 1.96;

/** A line of the plot; numbers are null where they do not exist. */
export interface ForestRow {
  kind: 'recording' | 'joint' | 'random';
  label: string;
  disagrees: boolean;
  estimate: Num;
  std_error: Num;
  interval95: [Num, Num] | null;
  z: Num;
  /** Name of a colour in place of that of its kind. */
  colour?: string;
}

function recordingRows(agreement: SharedAgreement, disagreeing: readonly number[]): ForestRow[] {
  return agreement.runs.map(({ estimate, std_error, z }, k) => {
    const reach = estimate !== null && std_error !== null ? kTwoSided95 * std_error : null;
    return {
      kind: 'recording',
      label: `recording ${k + 1}`,
      disagrees: disagreeing.includes(k + 1),
      estimate,
      std_error,
      interval95: estimate !== null && reach !== null ? [estimate - reach, estimate + reach] : null,
      z,
    };
  });
}

/** Each recording alone, the joint estimate where there is one, the mean of random effects. */
export function forestRows(fit: JointFit, name: string): ForestRow[] {
  const agreement = fit.homogeneity.parameters[name];
  const joint = fit.parameters?.[name];
  const scatter = agreement.random_effects;
  const rows = recordingRows(agreement, fit.homogeneity.disagreeing);
  const common = { disagrees: false, z: null };
  if (joint && joint.estimate !== null)
    rows.push({ ...common, ...pick(joint), kind: 'joint', label: 'joint fit' });
  if (scatter && scatter.mean !== null)
    rows.push({ ...common, ...pick({ ...scatter, estimate: scatter.mean }), kind: 'random', label: 'random effects' });
  return rows;
}

type Estimate = Pick<ForestRow, 'estimate' | 'std_error' | 'interval95'>;
const pick = ({ estimate, std_error, interval95 }: Estimate): Estimate => ({ estimate, std_error, interval95 });

const known = (x: Num | undefined): x is number => typeof x === 'number' && Number.isFinite(x);

/** Half the length of the interval; 0 where there is none. */
function reachOf({ interval95 }: ForestRow): number {
  const [low, high] = interval95 ?? [null, null];
  return known(low) && known(high) ? 0.5 * (high - low) : 0;
}

const kWide = 10; // times the median: such an interval says nothing beside the others
const kRoom = 6; // medians of half an interval, or
const kSpreads = 1.5; // of all estimates, that are shown beyond the outermost estimate

/** Median of what is positive, the lower one of two; 0 of nothing. */
function lowerMedian(values: number[]): number {
  const positive = values.filter((value) => value > 0).sort((a, b) => a - b);
  return positive[(positive.length - 1) >> 1] ?? 0;
}

/**
 * Range of the axis: all estimates that are known about as well as the others, and of the intervals as much as leaves
 * the others to be seen. Null where no estimate is known.
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

/** Where a row is drawn, as shares of the axis; `cut`: its interval goes on there. */
export interface Place {
  from: number;
  to: number;
  /** Null where the estimate itself is beyond the axis. */
  at: number | null;
  cutLow: boolean;
  cutHigh: boolean;
}

/** Null of a row without an estimate. */
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

/** What the rows are called that are longer than drawn. */
export function clipped(rows: ForestRow[], range: readonly [number, number]): string[] {
  return rows.flatMap((row) => {
    const place = placeOf(row, range);
    return place && (place.cutLow || place.cutHigh) ? [row.kind === 'recording' ? row.label : `the ${row.label}`] : [];
  });
}
