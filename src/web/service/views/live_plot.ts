// SPDX-License-Identifier: Apache-2.0
/** Plot of a recording in progress: its last seconds, all of it, or a part that stays while more arrives. */

import { Chart, padded, type Range } from '../../shared/chart';
import { decimate } from '../../shared/decimate';
import { kMeasured } from '../../shared/marks';
import { significant } from '../../shared/rounding';
import { extent, lowerBound } from '../../shared/samples';
import { unitText } from '../../shared/units';

const kFirstRoom = 1024; // samples, first size of the arrays

/** Samples in order of arrival, in arrays that grow. A new run replaces the old one. */
export class LiveSamples {
  private room = kFirstRoom;
  private times = new Float64Array(kFirstRoom);
  private readings = new Float64Array(kFirstRoom);
  count = 0;

  get time(): Float64Array {
    return this.times.subarray(0, this.count);
  }

  get values(): Float64Array {
    return this.readings.subarray(0, this.count);
  }

  get last(): number | null {
    return this.count === 0 ? null : this.times[this.count - 1];
  }

  clear(): void {
    this.count = 0;
  }

  private grow(count: number): void {
    while (this.room < count) this.room *= 2;
    const [times, readings] = [new Float64Array(this.room), new Float64Array(this.room)];
    times.set(this.time);
    readings.set(this.values);
    [this.times, this.readings] = [times, readings];
  }

  /** Adds a sample; without a value it is a gap. A time before the last one begins a new run. */
  add(times: readonly number[], values: readonly (number | null)[]): void {
    if (times.length === 0) return;
    if (this.last !== null && times[0] < this.last) this.clear();
    if (this.count + times.length > this.room) this.grow(this.count + times.length);
    times.forEach((time, i) => {
      this.times[this.count] = time;
      this.readings[this.count++] = values[i] ?? NaN;
    });
  }
}

export class LivePlot {
  readonly chart: Chart;
  unit = 'rad';
  /** Visible seconds; null for all. */
  span: number | null = 20;
  private waiting = false;
  private zoomed: Range | null = null;

  constructor(private readonly samples: LiveSamples) {
    this.chart = new Chart({
      sentence: () => `Readings from ${significant(this.range()[0], 4)} to ${significant(this.range()[1], 4)} s.`,
      xLabel: 'time [s]',
      yLabel: () => `reading [${unitText(this.unit)}]`,
      xRange: () => this.range(),
      yRange: () => padded(extent([this.seen()])),
      draw: (painter) => {
        const [from, to] = this.range();
        const { x, y } = decimate(this.samples.time, this.samples.values, from, to, this.chart.columns);
        painter.line(x, y, { ...kMeasured, colour: 'curve-1', width: 1.5 });
      },
      height: 330,
      onSelect: (from, to) => this.zoom([from, to]),
    });
    this.chart.host.addEventListener('dblclick', () => this.zoom(null));
  }

  /** Shows a part that does not move on; null for the range of `span` again. */
  zoom(range: Range | null): void {
    this.zoomed = range;
    this.chart.update();
  }

  private range(): Range {
    if (this.zoomed) return this.zoomed;
    const { last, time, count } = this.samples;
    if (last === null) return [0, this.span ?? 1];
    const first = this.span === null ? time[0] : Math.max(time[0], last - this.span);
    return count < 2 ? [first, first + 1] : [first, last];
  }

  private seen(): Float64Array {
    const [from, to] = this.range();
    const { time, values } = this.samples;
    return values.subarray(lowerBound(time, from), this.zoomed ? lowerBound(time, to) : undefined);
  }

  /** Draws at the next frame, only once for several calls. */
  update(): void {
    if (this.waiting) return;
    this.waiting = true;
    requestAnimationFrame(() => {
      this.waiting = false;
      this.chart.update();
    });
  }
}
