// SPDX-License-Identifier: Apache-2.0
/** Reduces millions of samples to the minimum and maximum of each pixel column. */

import { lowerBound } from './samples';

/**
 * Points to draw, in order of time. NaN in y breaks the line. `dense`: these are the extremes of columns, not all
 * samples.
 */
export interface Shown {
  x: Float64Array;
  y: Float64Array;
  dense: boolean;
}

class Points {
  private count = 0;
  private readonly x: Float64Array;
  private readonly y: Float64Array;
  constructor(capacity: number) {
    this.x = new Float64Array(capacity);
    this.y = new Float64Array(capacity);
  }
  add(x: number, y: number): void {
    this.x[this.count] = x;
    this.y[this.count++] = y;
  }
  done(dense: boolean): Shown {
    return { x: this.x.subarray(0, this.count), y: this.y.subarray(0, this.count), dense };
  }
}

/** All samples with index first to end - 1. The line is broken at intervals longer than `gap`. */
function everySample(time: Float64Array, values: Float64Array, first: number, end: number, gap: number): Shown {
  const points = new Points(2 * (end - first));
  for (let i = first; i < end; ++i) {
    if (i > first && time[i] - time[i - 1] > gap) points.add(time[i], NaN);
    points.add(time[i], values[i]);
  }
  return points.done(false);
}

/** Minimum and maximum of each pixel column, in order of time. */
function extremesOfColumns(
  time: Float64Array,
  values: Float64Array,
  first: number,
  end: number,
  columns: number,
  gap: number,
): Shown {
  const points = new Points(3 * columns + 9);
  const width = (time[end - 1] - time[first]) / columns;
  let before = time[first];
  for (let i = first; i < end;) {
    const limit = time[first] + (Math.floor((time[i] - time[first]) / width) + 1) * width;
    let least = i;
    let largest = i;
    if (time[i] - before > gap) points.add(time[i], NaN);
    for (; i < end && (time[i] < limit || i === least); ++i) {
      if (values[i] < values[least] || Number.isNaN(values[least])) least = i;
      if (values[i] > values[largest] || Number.isNaN(values[largest])) largest = i;
    }
    before = time[i - 1];
    const [one, other] = least < largest ? [least, largest] : [largest, least];
    points.add(time[one], values[one]);
    if (other !== one) points.add(time[other], values[other]);
  }
  return points.done(true);
}

const kFewPerColumn = 4; // samples; up to this number all are drawn

/**
 * Points to draw for the samples in [from, to], and for one sample beyond each end, on this number of pixel columns.
 * All extremes of the range are among them. time: N, s, increasing. values: N. gap: s; the line is broken at longer
 * intervals. Takes O(N).
 */
export function decimate(
  time: Float64Array,
  values: Float64Array,
  from: number,
  to: number,
  columns: number,
  gap = Infinity,
): Shown {
  const first = Math.max(0, lowerBound(time, from) - 1);
  const end = Math.min(time.length, lowerBound(time, to) + 1);
  if (end <= first) return { x: new Float64Array(0), y: new Float64Array(0), dense: false };
  if (end - first <= kFewPerColumn * columns) return everySample(time, values, first, end, gap);
  return extremesOfColumns(time, values, first, end, columns, gap);
}
