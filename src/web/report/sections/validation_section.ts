// SPDX-License-Identifier: Apache-2.0
/** Measured, fitted and textbook motion in one plot; for slow sampling the apparent swing. */

import { el, text, toggle } from '../../shared/dom';
import { kApparent, kLinear, kMeasured, kNonlinear, modelMark, swatch } from '../../shared/marks';
import { keyboardBox, navigationButtons } from '../../shared/navigation';
import { significant } from '../../shared/rounding';
import { medianInterval, type Samples } from '../../shared/samples';
import { absent, figure, section } from '../../shared/section';
import { TimeView } from '../../shared/time_view';
import { inDegrees, quantityOf, shownUnit, unitText } from '../../shared/units';
import { apparentFrequency, apparentSwing } from '../aliasing';
import { curveTurns, zeroOf } from '../envelope';
import { isAliased, rankOf, shownFitOf, type OneRecording, type RecordedFit } from '../report';
import { TimePlot, type Trace } from '../time_plot';

/** Time zero of the plot, s on the file's clock: the release, or the start of the window. */
function origin({ data }: OneRecording, fit: RecordedFit): { time: number; words: string } {
  const release = fit.parameters.release_time?.estimate;
  if (typeof release === 'number') return { time: release, words: 'time since the release [s]' };
  return { time: data.window_s[0], words: 'time since the start of the window [s]' };
}

function closedFormTraces({ report }: OneRecording, samples: Samples, fit: RecordedFit): Trace[] {
  const model = samples.models.get(fit.model);
  const candidates: [string, Float64Array | null | undefined, Trace['mark']][] = [
    ['linear closed form', model?.linear, kLinear],
    ['full equation, closed-form values', model?.nonlinear, kNonlinear],
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

/** The fitted swing and the slower apparent one. Null if the motion is unknown. */
function slowTraces({ report, data }: OneRecording, samples: Samples, fit: RecordedFit): Slow | null {
  const motion = samples.motions.get(fit.model);
  const rate = data.sampling?.rate_hz;
  if (!motion || !rate) return null;
  const zero = zeroOf(fit.parameters, data.window_s[0]);
  const about = motion.reading.map((value, i) => value - zero(motion.time[i]));
  const turns = curveTurns(motion.time, about, () => 0);
  if (turns.length < 3) return null;
  const frequency = (turns.length - 1) / (2 * (turns[turns.length - 1].time - turns[0].time));
  const { apparent, cycles } = apparentFrequency(frequency, rate);
  const firstSign = Math.sign(about[motion.time.findIndex((t) => t >= turns[0].time)]);
  const slow = apparentSwing(turns, firstSign, motion.time, cycles, rate, samples.time[0]);
  const traces: Trace[] = [
    {
      name: 'true swing, fitted',
      time: motion.time,
      values: motion.reading,
      mark: modelMark(rankOf(report.result, report.shown)),
      shown: true,
    },
    { name: 'apparent swing', time: motion.time, values: slow.map((value, i) => value + zero(motion.time[i])), mark: kApparent, shown: true },
  ];
  const words =
    `The pendulum swings at f = ${significant(frequency, 4)} Hz and was sampled at fₛ = ${significant(rate, 4)} Hz. ` +
    `The samples also lie on a slower swing of |f − ${cycles === 1 ? '' : `${cycles} `}fₛ| = ${significant(apparent, 4)} Hz. A plot of the samples seems to show that swing.`;
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

/** Shows only the first swings if there are many, so that differences can be seen. A button shows all. */
function firstView(time: Float64Array, one: OneRecording): TimeView {
  const [from, to] = [time[0], time[time.length - 1]];
  const view = new TimeView(from, to, 8 * medianInterval(time));
  const frequency = one.data.sampling?.frequency_hz;
  const many = isAliased(one) ? kFirstSwings + 2 : kManySwings;
  if (frequency && (to - from) * frequency > many) view.set(Math.max(from, -1 / frequency), kFirstSwings / frequency);
  return view;
}

function overlay(one: OneRecording, samples: Samples, fit: RecordedFit, curves: Trace[], sentence: string): HTMLElement {
  const { time: start, words } = origin(one, fit);
  const measured: Trace = {
    name: 'measured',
    time: samples.time,
    values: samples.measured,
    mark: kMeasured,
    shown: true,
  };
  const traces = moved([measured, ...curves], start);
  const view = firstView(traces[0].time, one);
  const degrees = inDegrees(samples.unit);
  const plot = new TimePlot(traces, view, {
    name: 'textbook',
    sentence: () => sentence,
    xLabel: words,
    yLabel: () => `${quantityOf(samples.unit)} [${shownUnit(samples.unit).unit}]`,
    factor: () => shownUnit(samples.unit).factor,
    right: degrees && { label: `[${unitText(samples.unit)}]`, factor: 1 / degrees.factor },
    height: 300,
    behind: (painter) => painter.vertical(0, 'rule', [3, 3]),
  });
  const legend = el('div', { class: 'legend', role: 'group', 'aria-label': 'Curves shown' });
  for (const trace of traces) {
    legend.append(toggle([swatch(trace.mark), trace.name], true, (on) => plot.setShown(trace, on)));
  }
  const bar = el('div', { class: 'bar' }, legend, navigationButtons(view));
  const rest = ' The plot begins with the first swings. Show all shows the rest.';
  const caption = el('span', {}, sentence, !view.whole && el('span', { class: 'hint' }, rest));
  return figure(caption, keyboardBox('Measured and textbook motion', view, plot.chart.withButtons()), bar);
}

function slowPart(one: OneRecording, samples: Samples, fit: RecordedFit): HTMLElement | null {
  const slow = slowTraces(one, samples, fit);
  if (!slow) return null;
  return el(
    'div',
    {},
    text(slow.words),
    overlay(
      one,
      samples,
      fit,
      slow.traces,
      'The plot shows the samples, the fitted swing, and the slower swing that the samples seem to show.',
    ),
  );
}

export function validationSection(one: OneRecording): HTMLElement {
  const fit = shownFitOf(one);
  const { samples } = one;
  const title = 'Against the textbook';
  if (!fit || !samples)
    return section(
      'validation',
      title,
      absent('Without a fit and its samples there is nothing to compare.'),
    );
  if (isAliased(one)) {
    const part = slowPart(one, samples, fit);
    const why =
      'The recording has fewer than two samples in a period. The motion of this law between the samples cannot be drawn.';
    return section('validation', 'Sampled too slowly: true and apparent swing', part ?? absent(why));
  }
  const curves = closedFormTraces(one, samples, fit);
  if (curves.length < 2)
    return section('validation', title, absent('This law has not been compared with closed forms (--checks full).'));
  const sentence =
    'The plot shows the readings, the linear closed form, the nonlinear equation with the same textbook numbers, and the fit, from the release on.'.replace(
      'release',
      fit.parameters.release_time ? 'release' : 'start of the window',
    );
  return section('validation', title, overlay(one, samples, fit, curves, sentence));
}
