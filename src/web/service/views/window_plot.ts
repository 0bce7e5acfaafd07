// SPDX-License-Identifier: Apache-2.0
/**
 * Plot of the whole recording and of a window in it. Two handles move the ends of the window. Dragging elsewhere zooms,
 * as in all plots.
 */

import { Chart, padded, type Range } from '../../shared/chart';
import { decimate } from '../../shared/decimate';
import { button, el } from '../../shared/dom';
import { kMeasured } from '../../shared/marks';
import { followPointer, navigationButtons } from '../../shared/navigation';
import type { Painter } from '../../shared/painter';
import { fixed, timeText, windowText } from '../../shared/rounding';
import { extent, medianInterval, toArray } from '../../shared/samples';
import { TimeView } from '../../shared/time_view';
import { inShownUnit, quantityOf, shownUnit } from '../../shared/units';
import type { WholeRecording } from '../types';

export type Window = [number, number];

const kGap = 5; // median intervals
const kLeastShare = 1e-3; // of the recording: the narrowest window and the narrowest zoom
const kKeyShare = 0.01; // of the visible range, for an arrow key; ten times that with Shift
const kEnds = ['Begin of the window', 'End of the window'];

/** The window after its end 0 or 1 has moved to `at`. It stays in [first, last] and at least `least` wide. */
export function movedEnd(window: Window, end: 0 | 1, at: number, [first, last]: Window, least: number): Window {
  const [from, to] = window;
  return end === 0
    ? [Math.min(Math.max(at, first), to - least), to]
    : [from, Math.max(Math.min(at, last), from + least)];
}

/** The window to the millisecond, or to a tenth of the least width, so that rounding does not close a narrow window. */
export function roundedWindow([from, to]: Window, least: number): Window {
  const decimals = Math.max(3, Math.ceil(1 - Math.log10(least)));
  const rounded = (time: number): number => Number(fixed(time, decimals).replace('−', '-'));
  return [rounded(from), rounded(to)];
}

export class WindowPlot {
  readonly chart: Chart;
  /** The plot with its handles and buttons. */
  readonly element: HTMLElement;
  private readonly time: Float64Array;
  private readonly values: Float64Array;
  private readonly gap: number;
  private readonly view: TimeView;
  private readonly handles: HTMLElement[];

  /** used: the fitted window, if there is one. `change` is called with each window that the user chooses. */
  constructor(
    recording: WholeRecording,
    private readonly used: Window | null,
    private chosen: Window,
    private readonly change: (window: Window) => void,
  ) {
    this.time = Float64Array.from(recording.time_s);
    this.values = inShownUnit(toArray(recording.measured, this.time.length) ?? new Float64Array(0), recording.unit);
    this.gap = kGap * medianInterval(this.time);
    const [first, last] = this.ends;
    const margin = 0.01 * (last - first);
    this.view = new TimeView(first - margin, last + margin, kLeastShare * (last - first));
    const { unit } = shownUnit(recording.unit);
    this.chart = new Chart({
      sentence: () => this.sentence(),
      xLabel: 'time [s]',
      yLabel: () => `${quantityOf(recording.unit)} [${unit}]`,
      xRange: () => this.view.current,
      yRange: () => this.vertical,
      draw: (painter) => this.draw(painter),
      height: 210,
      onSelect: (from, to) => this.view.set(from, to),
    });
    followPointer(this.chart, this.view);
    this.view.onChange(() => this.chart.update());
    this.handles = ([0, 1] as const).map((end) => this.handle(end));
    const shown = button('Choose what is shown', () => this.chooseShown());
    this.element = el(
      'div',
      {},
      el('div', { class: 'window-box' }, this.chart.host, ...this.handles),
      el('div', { class: 'bar' }, shown, navigationButtons(this.view)),
    );
  }

  private get vertical(): Range {
    return padded(extent([this.values]));
  }

  get ends(): Window {
    return [this.time[0] ?? 0, this.time[this.time.length - 1] ?? 1];
  }

  private get duration(): number {
    return this.ends[1] - this.ends[0];
  }

  private get least(): number {
    return kLeastShare * this.duration;
  }

  private sentence(): string {
    const part = (window: Window): string => `from ${windowText(window, this.duration)}`;
    const used = this.used ? `; fitted ${part(this.used)}` : '';
    return `The whole recording ${part(this.ends)}${used}; chosen ${part(this.chosen)}.`;
  }

  /** Shows another window. */
  choose(window: Window): void {
    this.chosen = window;
    this.chart.update();
  }

  /** Shows a window that the user has chosen. */
  private take(window: Window): void {
    this.choose(roundedWindow(window, this.least));
    this.change(this.chosen);
  }

  private chooseShown(): void {
    const [first, last] = this.ends;
    const [low, high] = this.view.current;
    // The view may lie in the margin beside the recording.
    const from = Math.min(Math.max(first, low), last - this.least);
    this.take([from, Math.max(Math.min(last, high), from + this.least)]);
  }

  private draw(painter: Painter): void {
    const [from, to] = this.chosen;
    painter.span(from, to, 'band');
    const [first, last] = this.view.current;
    const { x, y, dense } = decimate(this.time, this.values, first, last, this.chart.columns, this.gap);
    if (dense || x.length > this.chart.columns / 3) painter.line(x, y, { ...kMeasured, width: 1.25 });
    else painter.dots(x, y, kMeasured.colour, 2);
    for (const end of this.used ?? []) painter.vertical(end, 'rule', [4, 4]);
    this.placeHandles();
  }

  private placeHandles(): void {
    const { over } = this.chart;
    if (!over) return;
    const [box, host] = [over.getBoundingClientRect(), this.chart.host.getBoundingClientRect()];
    const [low, high] = this.view.current;
    this.handles.forEach((handle, end) => {
      const share = (this.chosen[end] - low) / (high - low);
      handle.hidden = share < 0 || share > 1;
      handle.style.left = `${box.left - host.left + share * box.width}px`;
      handle.style.top = `${box.top - host.top}px`;
      handle.style.height = `${box.height}px`;
      handle.setAttribute('aria-valuenow', String(this.chosen[end]));
      handle.setAttribute('aria-valuetext', `${timeText(this.chosen[end], this.duration)} s`);
    });
  }

  private handle(end: 0 | 1): HTMLElement {
    const [first, last] = this.ends;
    const element = el('div', {
      class: 'window-handle',
      role: 'slider',
      tabindex: '0',
      'aria-label': kEnds[end],
      'aria-orientation': 'horizontal',
      'aria-valuemin': String(first),
      'aria-valuemax': String(last),
      'aria-valuenow': String(this.chosen[end]),
    });
    const moveTo = (at: number): void => this.take(movedEnd(this.chosen, end, at, this.ends, this.least));
    let isHeld = false;
    element.addEventListener('pointerdown', (event) => {
      if (event.button !== 0) return;
      isHeld = true;
      element.setPointerCapture(event.pointerId);
    });
    element.addEventListener('pointermove', (event) => {
      const left = this.chart.over?.getBoundingClientRect().left ?? 0;
      if (isHeld) moveTo(this.chart.xAt(event.clientX - left));
    });
    for (const over of ['pointerup', 'pointercancel'] as const) element.addEventListener(over, () => (isHeld = false));
    element.addEventListener('keydown', (event) => {
      const [low, high] = this.view.current;
      const step = kKeyShare * (high - low) * (event.shiftKey ? 10 : 1);
      const targets: Record<string, number> = {
        ArrowLeft: this.chosen[end] - step,
        ArrowDown: this.chosen[end] - step,
        ArrowRight: this.chosen[end] + step,
        ArrowUp: this.chosen[end] + step,
        Home: first,
        End: last,
      };
      if (!Object.hasOwn(targets, event.key)) return;
      event.preventDefault();
      moveTo(targets[event.key]);
    });
    return element;
  }
}
