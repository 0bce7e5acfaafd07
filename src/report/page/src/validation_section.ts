// SPDX-License-Identifier: Apache-2.0
/** The textbook's motion beside the measured and the fitted; what slow sampling makes of a swing. */

import { apparentFrequency, apparentSwing } from './aliasing';
import { el, text, toggle } from './dom';
import { curveTurns, zeroOf } from './envelope';
import { quantityOf } from './fit_section';
import { kApparent, kLinear, kMeasured, kNonlinear, modelMark, swatch } from './marks';
import { keyboardBox, navigationButtons } from './navigation';
import { hasWarning, rankOf, shownFit, type Report } from './report';
import { significant } from './rounding';
import { medianInterval, rootMeanSquare, type Samples } from './samples';
import { absent, figure, section } from './section';
import { table } from './table';
import { TimePlot, type Trace } from './time_plot';
import { TimeView } from './time_view';
import { fittedMotion } from './trajectory';
import type { Fit, Sampling } from './types';
import { inDegrees, unitText } from './units';

/** Instant the overlay counts from, s on the file's clock: the release, or the start of the window. */
function origin(report: Report, fit: Fit): { time: number; words: string } {
  const release = fit.parameters.release_time?.estimate;
  if (typeof release === 'number') return { time: release, words: 'time since the release [s]' };
  return { time: report.result.data.window_s[0], words: 'time since the start of the window [s]' };
}

const sampling = (report: Report): Sampling | null => report.result.data.sampling ?? null;

/** True when the swing is sampled less than twice a period. */
export function aliased(report: Report): boolean {
  const margin = sampling(report)?.nyquist_margin;
  return hasWarning(report.result, 'aliased') || (typeof margin === 'number' && margin < 1);
}

function difference(a: Float64Array, b: Float64Array): number {
  return rootMeanSquare(a.map((value, i) => value - b[i]));
}

function rmsTable(samples: Samples, curves: Trace[]): HTMLElement {
  const degrees = inDegrees(samples.unit);
  const rows = curves.map((curve) => {
    const rms = difference(samples.measured, curve.values);
    const other = degrees ? ` (${significant(rms * degrees.factor, 3)}${degrees.unit})` : '';
    return [[swatch(curve.mark), curve.name], `${significant(rms, 3)} ${unitText(samples.unit)}${other}`];
  });
  return table(
    'How far each motion is from the readings',
    [{ head: 'Motion' }, { head: 'Root mean square difference', kind: 'number' }],
    rows,
  );
}

function closedFormTraces(report: Report, samples: Samples, fit: Fit): Trace[] {
  const model = samples.models.get(fit.model);
  const candidates: [string, Float64Array | null | undefined, Trace['mark']][] = [
    ['linear closed form', model?.linear, kLinear],
    ['nonlinear, same numbers', model?.nonlinear, kNonlinear],
    [`fitted ${fit.model}`, model?.fitted, modelMark(rankOf(report.result, report.shown))],
  ];
  return candidates.flatMap(([name, values, mark]) =>
    values ? [{ name, time: samples.time, values, mark, shown: true }] : [],
  );
}

interface Slow {
  traces: Trace[];
  words: string;
}

/** Samples, the swing itself and the slow one that they seem to show. */
function slowTraces(report: Report, samples: Samples, fit: Fit): Slow | null {
  const { data } = report.result;
  const motion = fittedMotion(fit, data.window_s, data.clock_scale || 1);
  const rate = sampling(report)?.rate_hz;
  if (!motion || !rate) return null;
  const about = samples.unit === 'rad/s' ? motion.rate : motion.angle;
  const zero = zeroOf(fit.parameters, data.window_s[0]);
  const turns = curveTurns(motion.time, about, () => 0);
  if (turns.length < 3) return null;
  const frequency = (turns.length - 1) / (2 * (turns[turns.length - 1].time - turns[0].time));
  const { apparent, cycles } = apparentFrequency(frequency, rate);
  const firstSign = Math.sign(about[motion.time.findIndex((t) => t >= turns[0].time)]);
  const slow = apparentSwing(turns, firstSign, motion.time, cycles, rate, samples.time[0]);
  const shift = (values: Float64Array): Float64Array => values.map((value, i) => value + zero(motion.time[i]));
  const traces: Trace[] = [
    {
      name: 'true swing, fitted',
      time: motion.time,
      values: shift(about),
      mark: modelMark(rankOf(report.result, report.shown)),
      shown: true,
    },
    { name: 'apparent swing', time: motion.time, values: shift(slow), mark: kApparent, shown: true },
  ];
  const words =
    `The pendulum swings at f = ${significant(frequency, 4)} Hz and was sampled at fₛ = ${significant(rate, 4)} Hz. ` +
    `The samples lie just as well on a swing of |f − ${cycles === 1 ? '' : `${cycles} `}fₛ| = ${significant(apparent, 4)} Hz, which is what a plot of them seems to show.`;
  return { traces, words };
}

function moved(traces: Trace[], by: number): Trace[] {
  const clocks = new Map<Float64Array, Float64Array>();
  return traces.map((trace) => {
    if (!clocks.has(trace.time))
      clocks.set(
        trace.time,
        trace.time.map((t) => t - by),
      );
    return { ...trace, time: clocks.get(trace.time)! };
  });
}

const kManySwings = 30;
const kFirstSwings = 12;

/** The first swings of many, where differences can be seen; the button shows all. */
function firstView(time: Float64Array, report: Report): TimeView {
  const [from, to] = [time[0], time[time.length - 1]];
  const view = new TimeView(from, to, 8 * medianInterval(time));
  const frequency = sampling(report)?.frequency_hz;
  const many = aliased(report) ? kFirstSwings + 2 : kManySwings;
  if (frequency && (to - from) * frequency > many) view.set(Math.max(from, -1 / frequency), kFirstSwings / frequency);
  return view;
}

function overlay(report: Report, samples: Samples, fit: Fit, curves: Trace[], sentence: string): HTMLElement {
  const { time: start, words } = origin(report, fit);
  const measured: Trace = {
    name: 'measured',
    time: samples.time,
    values: samples.measured,
    mark: kMeasured,
    shown: true,
  };
  const traces = moved([measured, ...curves], start);
  const view = firstView(traces[0].time, report);
  const degrees = inDegrees(samples.unit);
  const plot = new TimePlot(traces, view, {
    sentence: () => sentence,
    xLabel: words,
    yLabel: () => `${quantityOf(samples.unit)} [${unitText(samples.unit)}]`,
    right: degrees && { label: `[${degrees.unit}]`, factor: degrees.factor },
    height: 300,
    behind: (painter) => painter.vertical(0, 'rule', [3, 3]),
  });
  const legend = el('div', { class: 'legend', role: 'group', 'aria-label': 'Curves shown' });
  for (const trace of traces) {
    legend.append(toggle([swatch(trace.mark), trace.name], true, (on) => plot.setShown(trace, on)));
  }
  const bar = el('div', { class: 'bar' }, legend, navigationButtons(view));
  const rest = ' The first swings are shown; Show all has the rest.';
  const caption = el('span', {}, sentence, !view.whole && el('span', { class: 'hint' }, rest));
  return figure(caption, keyboardBox('Measured and textbook motion', view, plot.chart.host), bar);
}

function slowPart(report: Report, samples: Samples, fit: Fit): HTMLElement | null {
  const slow = slowTraces(report, samples, fit);
  if (!slow) return null;
  return el(
    'div',
    {},
    text(slow.words),
    overlay(
      report,
      samples,
      fit,
      slow.traces,
      'Samples, the swing that was fitted to them, and the slower one that they seem to show.',
    ),
  );
}

export function validationSection(report: Report): HTMLElement {
  const fit = shownFit(report);
  const { samples } = report;
  const title = 'Against the textbook';
  if (!fit || !samples)
    return section(
      'validation',
      title,
      absent('Without a fit and its samples there is nothing to lay over each other.'),
    );
  if (aliased(report)) {
    const part = slowPart(report, samples, fit);
    const why =
      'The swing is sampled less than twice a period; for this model the motion between the samples cannot be drawn here.';
    return section('validation', 'Sampled too slowly: true and apparent swing', part ?? absent(why));
  }
  const curves = closedFormTraces(report, samples, fit);
  if (curves.length < 2)
    return section('validation', title, absent('There are no closed forms of this recording to lay over it.'));
  const sentence =
    'Measured motion, the linear closed form, the nonlinear equation with the same textbook numbers, and the fit, from the release on.'.replace(
      'release',
      fit.parameters.release_time ? 'release' : 'start of the window',
    );
  return section('validation', title, overlay(report, samples, fit, curves, sentence), rmsTable(samples, curves));
}
