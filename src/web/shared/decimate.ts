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
 * Points to draw for the samples in [from, to], and for one sample beyond each end, on this number of pixel columns:
 * all samples, or the extremes of each column if there are more than `few` samples in a column. time: N, s, increasing.
 * values: N. gap: s; the line is broken at longer intervals. Takes O(N).
 */
export function decimate(
  time: Float64Array,
  values: Float64Array,
  from: number,
  to: number,
  columns: number,
  gap = Infinity,
  few = kFewPerColumn,
): Shown {
  const first = Math.max(0, lowerBound(time, from) - 1);
  const end = Math.min(time.length, lowerBound(time, to) + 1);
  if (end <= first) return { x: new Float64Array(0), y: new Float64Array(0), dense: false };
  if (end - first <= few * columns) return everySample(time, values, first, end, gap);
  return extremesOfColumns(time, values, first, end, columns, gap);
}

/** The area between two curves: at each x from `low` to `high`. */
export interface ShownArea {
  x: Float64Array;
  low: Float64Array;
  high: Float64Array;
}

/**
 * The area between the curves `low` and `high` in [from, to], on this number of pixel columns. If there are more samples
 * than columns, each column has the least of `low` and the largest of `high`.
 */
export function decimateArea(
  time: Float64Array,
  low: Float64Array,
  high: Float64Array,
  from: number,
  to: number,
  columns: number,
): ShownArea {
  const first = Math.max(0, lowerBound(time, from) - 1);
  const end = Math.min(time.length, lowerBound(time, to) + 1);
  const stride = Math.max(1, Math.floor((end - first) / columns));
  const size = Math.max(0, Math.ceil((end - first) / stride));
  const area = { x: new Float64Array(size), low: new Float64Array(size), high: new Float64Array(size) };
  for (let k = 0; k < size; ++k) {
    const start = first + k * stride;
    const last = Math.min(end, start + stride);
    area.x[k] = 0.5 * (time[start] + time[last - 1]);
    area.low[k] = low.subarray(start, last).reduce((least, y) => Math.min(least, y));
    area.high[k] = high.subarray(start, last).reduce((most, y) => Math.max(most, y));
  }
  return area;
}
