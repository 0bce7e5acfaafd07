// SPDX-License-Identifier: Apache-2.0
/** All recordings of a joint fit in one plot, and their residuals. */

import { details, el, toggle } from '../../shared/dom';
import { swatch } from '../../shared/marks';
import { keyboardBox, navigationButtons } from '../../shared/navigation';
import { capital, inList } from '../../shared/prose';
import { fixed, significant } from '../../shared/rounding';
import { extent, lowerBound, medianInterval, rootMeanSquare } from '../../shared/samples';
import { absent, figure, section } from '../../shared/section';
import { table } from '../../shared/table';
import { TimeView } from '../../shared/time_view';
import { inDegrees, quantityOf, shownUnit, unitText } from '../../shared/units';
import { swingHeight } from '../swing';
import { TimePlot, type Trace } from '../time_plot';
import { originWords, overlay, type Overlaid, type Overlayable, type OverlaidKind } from './overlay';

type Kind = 'measured' | 'fitted';

const kRows = 60; // of the table
const kManySwings = 30;
const kFirstSwings = 12;

/**
 * The time range that all curves cover. It starts at 0, or on the clock of one recording at the latest first sample.
 */
function sharedTimes(curves: Overlaid[], { oneClock }: Overlayable): [number, number] {
  const times = curves.map((curve) => curve.measured.time);
  const start = oneClock ? Math.max(...times.map((time) => time[0])) : 0;
  return [start, Math.min(...times.map((time) => time[time.length - 1]))];
}

/** Of many swings, shows only the first ones that all curves have, so that differences can be seen. */
function viewOf(curves: Overlaid[], report: Overlayable): TimeView {
  const [from, to] = extent(curves.map((curve) => curve.measured.time)) ?? [0, 1];
  const least = 8 * Math.min(...curves.map((curve) => medianInterval(curve.measured.time)));
  const view = new TimeView(from, to, least);
  const frequency = report.recordings[curves[0].k].data.sampling?.frequency_hz;
  const [start, end] = sharedTimes(curves, report);
  if (frequency && (to - from) * frequency > kManySwings && start < end)
    view.set(Math.max(from, start - 1 / frequency), Math.min(to, start + kFirstSwings / frequency));
  return view;
}

/** A second axis in radians for an angle or a rate. */
function rightAxis(unit: string): { label: string; factor: number } | null {
  const degrees = inDegrees(unit);
  return degrees && { label: `[${unitText(unit)}]`, factor: 1 / degrees.factor };
}

class OverlayPlots {
  readonly view: TimeView;
  private readonly on: Record<Kind, boolean> = { measured: true, fitted: true };
  private readonly hidden = new Set<number>();
  private readonly main: TimePlot;
  private readonly below: TimePlot | null;

  constructor(
    private readonly curves: Overlaid[],
    private readonly unit: string,
    private readonly kind: OverlaidKind,
    report: Overlayable,
  ) {
    this.view = viewOf(curves, report);
    const reports = curves.map((curve) => report.recordings[curve.k]);
    const words = report.oneClock ? 'time of the recording [s]' : originWords(reports);
    const residuals = curves.flatMap((curve) => curve.residual ?? []);
    this.main = this.mainPlot(residuals.length > 0 ? '' : words);
    this.below = residuals.length > 0 ? this.residualPlot(residuals, words) : null;
  }

  /** "recordings 1 and 3" */
  private names(): string {
    const numbers = inList(this.curves.filter(({ k }) => !this.hidden.has(k)).map(({ k }) => k + 1));
    return `${this.kind}s ${numbers || 'none'}`;
  }

  private range(): string {
    const [from, to] = this.view.current;
    return `from ${significant(from, 4)} to ${significant(to, 4)} s`;
  }

  private mainPlot(xLabel: string): TimePlot {
    const right = rightAxis(this.unit);
    const kinds = (): string => (['measured', 'fitted'] as const).filter((kind) => this.on[kind]).join(' and ');
    const traces = this.curves.flatMap(({ measured, fitted }) => (fitted ? [measured, fitted] : [measured]));
    return new TimePlot(traces, this.view, {
      name: 'recordings',
      sentence: () =>
        `${capital(this.names())}, ${kinds() || 'nothing of them'}: ${quantityOf(this.unit)} over time ${this.range()}.`,
      xLabel,
      yLabel: () => `${quantityOf(this.unit)} [${shownUnit(this.unit).unit}]`,
      factor: () => shownUnit(this.unit).factor,
      right,
      aligned: right ? 'with right axis' : 'without',
      height: 330,
    });
  }

  private residualPlot(residuals: Trace[], xLabel: string): TimePlot {
    const { unit, factor } = shownUnit(this.unit);
    const size = (): string =>
      residuals
        .filter((trace) => trace.shown)
        .map((trace) => `${trace.name} ${significant(factor * rootMeanSquare(trace.values), 3)} ${unit}`)
        .join(', ');
    return new TimePlot(residuals, this.view, {
      name: 'residuals_of_recordings',
      every: true,
      sentence: () =>
        `Residuals (measured minus fitted) of ${this.names()} over time ${this.range()}; root mean squares: ${size() || 'none'}.`,
      xLabel,
      yLabel: () => `residual [${unit}]`,
      factor: () => factor,
      aligned: inDegrees(this.unit) ? 'with right axis' : 'without',
      height: 190,
      symmetric: true,
      behind: (painter) => painter.horizontal(0, 'rule'),
    });
  }

  private apply(): void {
    for (const { k, measured, fitted, residual } of this.curves) {
      const here = !this.hidden.has(k);
      measured.shown = here && this.on.measured;
      if (fitted) fitted.shown = here && this.on.fitted;
      if (residual) residual.shown = here;
    }
    this.main.chart.update();
    this.below?.chart.update();
  }

  private legend(): HTMLElement {
    const box = el('div', { class: 'legend', role: 'group', 'aria-label': `${capital(this.kind)}s shown` });
    for (const { k, fitted, measured } of this.curves) {
      const change = (on: boolean): void => {
        if (on) this.hidden.delete(k);
        else this.hidden.add(k);
        this.apply();
      };
      box.append(toggle([swatch((fitted ?? measured).mark), measured.name], true, change));
    }
    return box;
  }

  private kinds(): HTMLElement | null {
    if (this.curves.every((curve) => !curve.fitted)) return null;
    const box = el('div', { class: 'legend', role: 'group', 'aria-label': `Of each ${this.kind}` });
    for (const kind of ['measured', 'fitted'] as const) {
      const own = this.curves.find((curve) => curve[kind])?.[kind];
      const change = (on: boolean): void => {
        this.on[kind] = on;
        this.apply();
      };
      if (own) box.append(toggle([swatch({ ...own.mark, colour: 'measured' }), kind], true, change));
    }
    return box;
  }

  /** Table of some samples in the visible range. */
  private samples(): HTMLElement {
    const shown = this.curves.filter(({ k }) => !this.hidden.has(k));
    const each = Math.max(4, Math.floor(kRows / Math.max(1, shown.length)));
    const { unit, factor } = shownUnit(this.unit);
    const [from, to] = this.view.current;
    const rows = shown.flatMap(({ k, measured, residual }) => {
      const [first, end] = [lowerBound(measured.time, from), lowerBound(measured.time, to + 1e-12)];
      const stride = Math.max(1, Math.ceil((end - first) / each));
      const count = Math.max(0, Math.ceil((end - first) / stride));
      return Array.from({ length: count }, (_unused, j) => first + j * stride).map((i) => [
        String(k + 1),
        fixed(measured.time[i], 3),
        significant(factor * measured.values[i], 4),
        significant(residual && factor * (measured.values[i] - residual.values[i]), 4),
        significant(residual && factor * residual.values[i], 3),
      ]);
    });
    const number = 'number' as const;
    const heads = ['t [s]', `measured [${unit}]`, `fitted [${unit}]`, `residual [${unit}]`];
    const columns = [{ head: capital(this.kind) }, ...heads.map((head) => ({ head, kind: number }))];
    return table(`Some samples of each ${this.kind} shown`, columns, rows);
  }

  element(): HTMLElement {
    const box = keyboardBox(`All ${this.kind}s, and their residuals`, this.view, this.main.chart.withButtons());
    if (this.below)
      box.append(
        el('div', { class: 'bar residual' }, el('h3', {}, 'Residuals: measured − fitted')),
        this.below.chart.withButtons(),
      );
    const bars = [
      this.legend(),
      el('div', { class: 'bar' }, this.kinds() ?? el('span'), navigationButtons(this.view)),
    ];
    const hint = 'Drag to zoom. Double-click to show all. Shift and drag, or drag with a finger, to move.';
    const first = !this.view.whole && ' The plot begins with the first swings. Show all shows the rest.';
    const caption = el('span', { class: 'hint' }, hint, first);
    return el(
      'div',
      {},
      figure(caption, box, ...bars),
      details('Samples as a table', () => this.samples()),
    );
  }
}

/** All recordings with the joint fit, small enough for the first screen; null without samples. */
export function jointSwing(report: Overlayable): HTMLElement | null {
  const { curves, unit } = overlay(report);
  if (curves.length === 0) return null;
  const traces = curves.flatMap(({ measured, fitted }) => (fitted ? [fitted, measured] : [measured]));
  const numbers = inList(curves.map(({ k }) => k + 1));
  const plot = new TimePlot(traces, viewOf(curves, report), {
    name: 'swings',
    sentence: () => `The swings of recordings ${numbers} with the joint fit: ${quantityOf(unit)} over time.`,
    xLabel: originWords(curves.map(({ k }) => report.recordings[k])),
    yLabel: () => `${quantityOf(unit)} [${shownUnit(unit).unit}]`,
    factor: () => shownUnit(unit).factor,
    right: rightAxis(unit),
    height: swingHeight(),
  });
  const legend = el('ul', { class: 'legend', 'aria-label': 'Recordings' }, el('li', {}, 'recordings'));
  for (const { measured, k } of curves) legend.append(el('li', {}, swatch(measured.mark), String(k + 1)));
  return el('figure', { class: 'swing' }, legend, plot.chart.withButtons());
}

export function overlaySection(report: Overlayable, kind: OverlaidKind = 'recording'): HTMLElement {
  const title = `All ${kind}s over each other`;
  const { curves, unit, others } = overlay(report, kind);
  if (curves.length === 0)
    return section('overlay', title, absent('The samples are not part of this report, so there is nothing to draw.'));
  const left = `Not drawn, because samples are missing or have another unit: ${kind}${others.length === 1 ? '' : 's'} ${inList(others)}.`;
  return section('overlay', title, new OverlayPlots(curves, unit, kind, report).element(), others.length > 0 && absent(left));
}
