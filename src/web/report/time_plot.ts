// SPDX-License-Identifier: Apache-2.0
/**
 * Readings and curves over time. Only the points that the visible range needs are drawn, so millions of samples are
 * fast.
 */

import { Chart, padded, type Range } from '../shared/chart';
import { decimate, decimateArea, type Shown } from '../shared/decimate';
import type { Mark } from '../shared/marks';
import { followPointer } from '../shared/navigation';
import type { Painter } from '../shared/painter';
import { extent, medianInterval } from '../shared/samples';
import type { TimeView } from '../shared/time_view';

/** time: s, increasing. values: in the unit of the plot; NaN for a missing value. */
export interface Trace {
  name: string;
  time: Float64Array;
  values: Float64Array;
  mark: Mark;
  shown: boolean;
  /** Standard errors of the values; a band of 95 % is drawn where they are visible. */
  errors?: Float64Array | null;
}

export interface TimePlotOptions {
  /** Name of the files in which the plot is saved. */
  name: string;
  sentence: () => string;
  xLabel: string;
  yLabel: () => string;
  height: number;
  right?: { label: string; factor: number } | null;
  aligned?: 'with right axis' | 'without';
  /** Factor from values to the displayed unit, such as 1/σ; default 1. */
  factor?: () => number;
  /** Draws the background, before all traces. */
  behind?: (painter: Painter) => void;
  /** Draws after all traces. */
  inFront?: (painter: Painter) => void;
  /** Draws all samples as points, up to many in a column of pixels. */
  every?: boolean;
  /** Keeps zero in the middle of the vertical axis. */
  symmetric?: boolean;
  onCursor?: (time: number | null) => void;
}

const kMany = 30; // samples in a column of pixels
const kNormal95 = 1.96;
const kGap = 5; // median intervals; lines are broken at longer gaps

export class TimePlot {
  readonly chart: Chart;
  private shown: (Shown | null)[] = [];
  private readonly gaps: number[];
  private readonly bands = new Map<Trace, { low: Float64Array; high: Float64Array }>();

  constructor(
    readonly traces: Trace[],
    private readonly view: TimeView,
    private readonly options: TimePlotOptions,
  ) {
    this.gaps = traces.map((trace) => kGap * medianInterval(trace.time));
    for (const trace of traces) {
      const { values, errors } = trace;
      if (!errors) continue;
      const end = (sign: number): Float64Array => values.map((value, i) => value + sign * kNormal95 * errors[i]);
      this.bands.set(trace, { low: end(-1), high: end(1) });
    }
    this.chart = new Chart({
      ...options,
      xRange: () => view.current,
      yRange: () => this.yRange(),
      draw: (painter) => this.draw(painter),
      legend: () => traces.filter((trace) => trace.shown),
      onSelect: (from, to) => view.set(from, to),
    });
    followPointer(this.chart, view);
    const stop = view.onChange(() => (this.chart.removed ? stop() : this.chart.update()));
  }

  setShown(trace: Trace, shown: boolean): void {
    trace.shown = shown;
    this.chart.update();
  }

  /** Reduces the visible part of each trace to what is drawn. The vertical range depends on it. */
  private decimateAll(): void {
    const { columns } = this.chart;
    const [from, to] = this.view.current;
    const few = this.options.every ? kMany : undefined;
    this.shown = this.traces.map((trace, i) =>
      trace.shown ? decimate(trace.time, trace.values, from, to, columns, this.gaps[i], few) : null,
    );
    const factor = this.options.factor?.() ?? 1;
    if (factor === 1) return;
    for (const shown of this.shown) if (shown) shown.y = shown.y.map((y) => factor * y);
  }

  private yRange(): Range {
    this.decimateAll();
    const range = extent(this.shown.flatMap((shown) => (shown ? [shown.y] : [])));
    if (!this.options.symmetric || !range) return padded(range);
    const most = Math.max(Math.abs(range[0]), Math.abs(range[1]), 1e-300);
    return padded([-most, most]);
  }

  /** Bands first, then lines, then points: a curve does not cover the points near it. */
  private draw(painter: Painter): void {
    this.options.behind?.(painter);
    for (const trace of this.traces) if (trace.shown) this.drawErrors(painter, trace);
    for (const points of [false, true]) {
      this.shown.forEach((shown, i) => {
        const { mark } = this.traces[i];
        if (shown && Boolean(mark.points) === points) this.drawTrace(painter, shown, mark);
      });
    }
    this.options.inFront?.(painter);
  }

  private drawErrors(painter: Painter, trace: Trace): void {
    const band = this.bands.get(trace);
    if (!band) return;
    const { x, low, high } = decimateArea(trace.time, band.low, band.high, ...this.view.current, this.chart.columns);
    const factor = this.options.factor?.() ?? 1;
    const scaled = (values: Float64Array): Float64Array => (factor === 1 ? values : values.map((y) => factor * y));
    painter.area(x, scaled(low), scaled(high), 'band-curve');
  }

  private drawTrace(painter: Painter, shown: Shown, mark: Mark): void {
    const lineOfDense = { ...mark, dash: shown.dense ? [] : mark.dash };
    if (!mark.points) return painter.line(shown.x, shown.y, lineOfDense);
    if (shown.dense && this.options.every) return painter.line(shown.x, shown.y, { ...lineOfDense, width: 1 });
    const room = this.chart.columns / Math.max(1, shown.x.length); // px per sample
    const radius = room > 12 ? 3.2 : room > 2 ? 2 : room > 0.7 ? 1.4 : room > 0.2 ? 1 : 0.7;
    return painter.dots(shown.x, shown.y, mark.colour, radius);
  }
}
