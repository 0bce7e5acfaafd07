// SPDX-License-Identifier: Apache-2.0
/** Plot of the whole recording and its fitted window. Dragging selects another window. */

import { Chart, padded, type Range } from '../../shared/chart';
import { decimate } from '../../shared/decimate';
import { kMeasured } from '../../shared/marks';
import type { Painter } from '../../shared/painter';
import { fixed, significant } from '../../shared/rounding';
import { extent, medianInterval, toArray } from '../../shared/samples';
import { quantityOf, unitText } from '../../shared/units';
import type { WholeRecording } from '../types';

export type Window = [number, number];

const kReach = 14; // px; a drag that begins this close to an end of the window moves the end
const kGap = 5; // median intervals

/** The window after a drag from `held` to `at`: one end moves, or the drag selects a new window. */
export function draggedWindow(chosen: Window, held: number, at: number, reach: number): Window {
  const [from, to] = chosen;
  const other = Math.abs(held - from) <= reach ? to : Math.abs(held - to) <= reach ? from : held;
  return at < other ? [at, other] : [other, at];
}

export class WindowPlot {
  readonly chart: Chart;
  private readonly time: Float64Array;
  private readonly values: Float64Array;
  private readonly gap: number;

  /** used: the fitted window, if there is one. `change` is called with each window during a drag. */
  constructor(
    recording: WholeRecording,
    private readonly used: Window | null,
    private chosen: Window,
    private readonly change: (window: Window) => void,
  ) {
    this.time = Float64Array.from(recording.time_s);
    this.values = toArray(recording.measured, this.time.length) ?? new Float64Array(0);
    this.gap = kGap * medianInterval(this.time);
    const [first, last] = this.ends;
    const unit = unitText(recording.unit);
    this.chart = new Chart({
      sentence: () => this.sentence(),
      xLabel: 'time [s]',
      yLabel: () => `${quantityOf(recording.unit)} [${unit}]`,
      xRange: () => padded([first, last], 0.01),
      yRange: () => this.vertical,
      draw: (painter) => this.draw(painter),
      height: 210,
    });
    this.followPointer();
  }

  private get vertical(): Range {
    return padded(extent([this.values]));
  }

  get ends(): Window {
    return [this.time[0] ?? 0, this.time[this.time.length - 1] ?? 1];
  }

  private sentence(): string {
    const part = ([from, to]: Window): string => `from ${significant(from, 5)} to ${significant(to, 5)} s`;
    const used = this.used ? `; fitted ${part(this.used)}` : '';
    return `The whole recording ${part(this.ends)}${used}; chosen ${part(this.chosen)}.`;
  }

  /** Shows another window. */
  choose(window: Window): void {
    this.chosen = window;
    this.chart.update();
  }

  private draw(painter: Painter): void {
    const [from, to] = this.chosen;
    painter.span(from, to, 'band');
    const [first, last] = this.ends;
    const { x, y, dense } = decimate(this.time, this.values, first, last, this.chart.columns, this.gap);
    if (dense || x.length > this.chart.columns / 3) painter.line(x, y, { ...kMeasured, width: 1.25 });
    else painter.dots(x, y, kMeasured.colour, 2);
    for (const end of this.used ?? []) painter.vertical(end, 'rule', [4, 4]);
    const [low, high] = this.vertical;
    for (const end of [from, to]) painter.line([end, end], [low, high], { colour: 'curve-1', dash: [], width: 2.5 });
    painter.dots([from, to], [0.5 * (low + high), 0.5 * (low + high)], 'curve-1', 6);
  }

  private timeAt(clientX: number): number {
    const left = this.chart.over?.getBoundingClientRect().left ?? 0;
    const [first, last] = this.ends;
    return Math.min(last, Math.max(first, this.chart.xAt(clientX - left)));
  }

  private drag(held: number, before: Window, clientX: number): void {
    const [first, last] = this.ends;
    const reach = (kReach * (last - first)) / this.chart.columns;
    const [from, to] = draggedWindow(before, held, this.timeAt(clientX), reach);
    this.choose([Number(fixed(from, 3).replace('−', '-')), Number(fixed(to, 3).replace('−', '-'))]);
    this.change(this.chosen);
  }

  private followPointer(): void {
    const { host } = this.chart;
    let held: { time: number; before: Window; x: number } | null = null;
    host.classList.add('window-plot');
    host.addEventListener('pointerdown', (event) => {
      if (event.button !== 0) return;
      held = { time: this.timeAt(event.clientX), before: this.chosen, x: event.clientX };
      host.setPointerCapture(event.pointerId);
    });
    host.addEventListener('pointermove', (event) => {
      if (held && Math.abs(event.clientX - held.x) > 3) this.drag(held.time, held.before, event.clientX);
    });
    host.addEventListener('pointerup', () => (held = null));
    host.addEventListener('pointercancel', () => {
      if (!held) return;
      this.choose(held.before); // the finger scrolls the page instead
      this.change(held.before);
      held = null;
    });
  }
}
