// SPDX-License-Identifier: Apache-2.0
/** Of millions of samples only what a screen can show: the least and the largest of each column of pixels. */

import { lowerBound } from './samples';

/** Points to draw, in order of time; y NaN breaks the line. `dense`: extremes of columns, not all samples. */
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

/** All samples from first to before end, the line broken where the next is more than `gap` away. */
function everySample(time: Float64Array, values: Float64Array, first: number, end: number, gap: number): Shown {
  const points = new Points(2 * (end - first));
  for (let i = first; i < end; ++i) {
    if (i > first && time[i] - time[i - 1] > gap) points.add(time[i], NaN);
    points.add(time[i], values[i]);
  }
  return points.done(false);
}

/** The least and the largest of each column, in the order they come. */
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

const kFewPerColumn = 4; // samples: so many can all be drawn

/**
 * What to draw of samples in [from, to] (and one beyond either end) on so many columns of pixels. Every extreme of the
 * range is among it. time: N, s, increasing; values: N; gap: intervals longer than it break the line, s. O(N).
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
