// SPDX-License-Identifier: Apache-2.0
/** Decay of the amplitudes: turning points, the exponential of the log decrement, and the fitted motion. */

import { Chart, padded, type Key, type Range } from '../../shared/chart';
import { choice, el } from '../../shared/dom';
import { kLinear, kMeasured, modelMark, swatch, type Mark } from '../../shared/marks';
import type { Painter } from '../../shared/painter';
import { significant } from '../../shared/rounding';
import { extent } from '../../shared/samples';
import { absent, figure, section } from '../../shared/section';
import { inShownUnit, shownUnit } from '../../shared/units';
import { curveTurns, decrementRate, exponentialThrough, measuredTurns, zeroOf, type Turn } from '../envelope';
import { rankOf, shownFitOf, type OneRecording, type RecordedFit } from '../report';
import { told } from '../told';

interface Curve {
  name: string;
  mark: Mark;
  time: number[];
  amplitude: number[];
}

function curvesOf({ report, data, samples }: OneRecording, fit: RecordedFit | null, turns: Turn[]): Curve[] {
  const curves: Curve[] = [];
  const rate = decrementRate(data);
  const times = turns.map((turn) => turn.time);
  if (rate !== null) {
    const [first, last] = [times[0], times[times.length - 1]];
    const even = Array.from({ length: 101 }, (_unused, i) => first + ((last - first) * i) / 100);
    const periods = data.closed_forms?.linear?.periods as unknown;
    const used = typeof periods === 'number' ? 2 * periods + 1 : undefined;
    curves.push({
      name: 'log decrement',
      mark: kLinear,
      time: even,
      amplitude: exponentialThrough(turns, rate, even, used),
    });
  }
  const fitted = fit && samples?.models.get(fit.model)?.fitted;
  if (fit && samples && fitted) {
    const own = curveTurns(samples.time, fitted, zeroOf(fit.parameters, data.window_s[0]));
    const from = times[0] - 1e-9 - (times.length > 1 ? 0.3 * (times[1] - times[0]) : 0);
    const seen = own.filter((turn) => turn.time >= from);
    curves.push({
      name: `fitted ${fit.model}`,
      mark: modelMark(rankOf(report.result, report.shown)),
      time: seen.map((turn) => turn.time),
      amplitude: seen.map((turn) => turn.amplitude),
    });
  }
  return curves;
}

const keysOf = (curves: Curve[]): Key[] => [{ name: 'turning points', mark: kMeasured }, ...curves];

function legend(curves: Curve[]): HTMLElement {
  const box = el('ul', { class: 'legend', 'aria-label': 'Curves' });
  for (const { name, mark } of keysOf(curves)) box.append(el('li', {}, swatch(mark), name));
  return box;
}

class EnvelopePlot {
  private log = false;
  private readonly chart: Chart;

  constructor(
    private readonly turns: Turn[],
    private readonly curves: Curve[],
    unit: string,
  ) {
    const spans = extent([turns.map((turn) => turn.time), ...curves.map((curve) => curve.time)]);
    this.chart = new Chart({
      name: 'amplitudes',
      sentence: () =>
        `Amplitudes of ${turns.length} turning points from ${significant(turns[0].amplitude, 3)} to ` +
        `${significant(turns[turns.length - 1].amplitude, 3)} ${shownUnit(unit).unit} on a ${this.log ? 'logarithmic' : 'linear'} axis` +
        `${curves.length > 0 ? `, with ${curves.map((curve) => curve.name).join(' and ')}` : ''}.`,
      xLabel: 'time [s]',
      yLabel: () => `amplitude [${shownUnit(unit).unit}]`,
      xRange: () => padded(spans, 0.02),
      yRange: () => this.yRange(),
      yLog: () => this.log,
      draw: (painter) => this.draw(painter),
      legend: () => keysOf(curves),
      height: 300,
    });
  }

  private yRange(): Range {
    const all = [this.turns.map((turn) => turn.amplitude), ...this.curves.map((curve) => curve.amplitude)];
    if (!this.log) return [0, 1.06 * (extent(all)?.[1] ?? 1)];
    const top = extent(all)?.[1] ?? 1;
    const measured = extent([all[0].filter((amplitude) => amplitude > 0)]) ?? [top / 10, top];
    return [Math.max(measured[0] / 1.3, top * 1e-4), top * 1.15];
  }

  private draw(painter: Painter): void {
    const known = this.turns.filter((turn) => turn.error !== null);
    const least = this.log ? 1e-300 : -Infinity;
    painter.errorBars(
      known.map((turn) => turn.time),
      known.map((turn) => Math.max(least, turn.amplitude - (turn.error ?? 0))),
      known.map((turn) => turn.amplitude + (turn.error ?? 0)),
      'measured',
    );
    painter.dots(
      this.turns.map((turn) => turn.time),
      this.turns.map((turn) => turn.amplitude),
      'measured',
      this.turns.length > 120 ? 1.4 : 2.8,
    );
    for (const curve of this.curves) painter.line(curve.time, curve.amplitude, curve.mark);
  }

  element(): HTMLElement {
    const scales = [
      { value: 'linear', label: 'linear' },
      { value: 'log', label: 'logarithmic' },
    ];
    const bar = el(
      'div',
      { class: 'bar' },
      legend(this.curves),
      choice('Amplitude axis', scales, 'linear', (value) => {
        this.log = value === 'log';
        this.chart.rebuild();
      }),
    );
    const caption =
      'Viscous friction alone gives a straight line on the logarithmic axis, dry friction alone on the linear axis.';
    return figure(caption, this.chart.withButtons(), bar);
  }
}

export function envelopeSection(one: OneRecording): HTMLElement {
  const fit = shownFitOf(one);
  const { series, data } = one;
  const forms = data.closed_forms;
  const zero = zeroOf(fit?.parameters ?? forms?.decrement?.parameters ?? {}, data.window_s[0]);
  const turns = series ? measuredTurns(series, zero).filter((turn) => Number.isFinite(turn.amplitude)) : [];
  const title = 'Amplitudes';
  const words = told(one.report, 'envelope', title);
  if (!series) return section('envelope', title, absent('The samples are not part of this report.'), ...words);
  if (turns.length < 2) {
    const why = 'No turning points were found. The recording has too few samples in a period, or nothing swings.';
    return section('envelope', title, absent(why), ...words);
  }
  const { factor } = shownUnit(series.unit);
  const shown = turns.map((turn) => ({ ...turn, amplitude: factor * turn.amplitude, error: turn.error && factor * turn.error }));
  const curves = curvesOf(one, fit, turns).map((curve) => ({ ...curve, amplitude: inShownUnit(curve.amplitude, series.unit) }));
  const plot = new EnvelopePlot(shown, curves, series.unit);
  return section('envelope', title, plot.element(), ...words);
}
