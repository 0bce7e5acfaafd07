// SPDX-License-Identifier: Apache-2.0
/**
 * Readings and curves over time. Only the points that the visible range needs are drawn, so millions of samples are
 * fast.
 */

import { Chart, padded, type Range } from '../shared/chart';
import { decimate, type Shown } from '../shared/decimate';
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
}

export interface TimePlotOptions {
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
  /** Keeps zero in the middle of the vertical axis. */
  symmetric?: boolean;
  onCursor?: (time: number | null) => void;
}

const kGap = 5; // median intervals; lines are broken at longer gaps

export class TimePlot {
  readonly chart: Chart;
  private shown: (Shown | null)[] = [];
  private readonly gaps: number[];

  constructor(
    readonly traces: Trace[],
    private readonly view: TimeView,
    private readonly options: TimePlotOptions,
  ) {
    this.gaps = traces.map((trace) => kGap * medianInterval(trace.time));
    this.chart = new Chart({
      ...options,
      xRange: () => view.current,
      yRange: () => this.yRange(),
      draw: (painter) => this.draw(painter),
      onSelect: (from, to) => view.set(from, to),
    });
    followPointer(this.chart, view);
    view.onChange(() => this.chart.update());
  }

  setShown(trace: Trace, shown: boolean): void {
    trace.shown = shown;
    this.chart.update();
  }

  /** Reduces the visible part of each trace to what is drawn. The vertical range depends on it. */
  private decimateAll(): void {
    const { columns } = this.chart;
    const [from, to] = this.view.current;
    this.shown = this.traces.map((trace, i) =>
      trace.shown ? decimate(trace.time, trace.values, from, to, columns, this.gaps[i]) : null,
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

  private draw(painter: Painter): void {
    this.options.behind?.(painter);
    this.shown.forEach((shown, i) => shown && this.drawTrace(painter, shown, this.traces[i].mark));
  }

  private drawTrace(painter: Painter, shown: Shown, mark: Mark): void {
    const lineOfDense = { ...mark, dash: shown.dense ? [] : mark.dash };
    if (!mark.points) return painter.line(shown.x, shown.y, shown.dense ? lineOfDense : mark);
    if (shown.dense) return painter.line(shown.x, shown.y, { ...lineOfDense, width: 1 });
    const room = this.chart.columns / Math.max(1, shown.x.length); // px per sample
    return painter.dots(
      shown.x,
      shown.y,
      mark.colour,
      room > 12 ? 3.2 : room > 2 ? 2.4 : mark.colour === 'measured' ? 2 : 1.3,
    );
  }
}
