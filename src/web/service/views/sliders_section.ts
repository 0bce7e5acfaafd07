// SPDX-License-Identifier: Apache-2.0
/** The measured swing, and the swing of the fitted law for parameters that the reader sets with sliders. */

import { shownFitOf, type OneRecording } from '../../report/report';
import { TimePlot, type Trace } from '../../report/time_plot';
import { button, el, symbolElement, text } from '../../shared/dom';
import { kMeasured, modelMark, swatch } from '../../shared/marks';
import { keyboardBox, navigationButtons } from '../../shared/navigation';
import type { Fit } from '../../shared/result_types';
import { significant } from '../../shared/rounding';
import { rootMeanSquare, type Samples } from '../../shared/samples';
import { figure, section } from '../../shared/section';
import { TimeView } from '../../shared/time_view';
import { inDegrees, quantityOf, spacedUnit, symbolOf, unitText, wordsOf } from '../../shared/units';
import { Cancelled, problemOf } from '../server/problem';
import { readingsOf } from '../server/readings';
import { FollowedCurve, type Curve } from './followed_curve';
import { scalesOf, sliderNames, sliderRange, type Scales } from './slider_ranges';

const kSteps = 400; // of a slider
const kMostSamples = 4000; // of a curve, as of the service
const kDigits = 4;

/** "0.0790 kg m²", "28.6 °". */
export function valueWords(value: number, unit: string): string {
  const degrees = inDegrees(unit);
  return significant(value * (degrees?.factor ?? 1), kDigits) + spacedUnit(degrees?.unit ?? unit);
}

/** Every k-th value, so that at most kMostSamples remain. */
const thinned = (values: Float64Array): Float64Array => {
  const stride = Math.ceil(values.length / kMostSamples);
  return values.filter((_value, i) => i % stride === 0);
};

class SlidersSection {
  private readonly estimates: Record<string, number> = {};
  private readonly values: Record<string, number>;
  /** The curve of the fit, and its residual. */
  private readonly best: Curve;
  private readonly simulated: Trace;
  private simulatedRms: number;
  private readonly plot: TimePlot;
  private readonly view: TimeView;
  private readonly rms = el('output', { class: 'slider-rms' });
  private readonly problem = el('p', { role: 'status' });
  private readonly resets: (() => void)[] = [];
  private readonly curve: FollowedCurve;

  constructor(
    private readonly of: { id: string; recording: number; signal: AbortSignal },
    private readonly fit: Fit,
    private readonly scales: Scales,
    private readonly samples: Samples,
    fitted: Float64Array,
  ) {
    for (const [name, { estimate }] of Object.entries(fit.parameters)) this.estimates[name] = estimate ?? NaN;
    this.values = { ...this.estimates };
    const [time, values, measuredThere] = [samples.time, fitted, samples.measured].map(thinned);
    this.best = { time, values, rms: rootMeanSquare(measuredThere.map((value, i) => value - values[i])) };
    this.curve = new FollowedCurve(
      this.best,
      (changed, signal) => this.askFor(changed, signal),
      (curve, problem) => this.show(curve, problem),
      of.signal,
    );
    this.simulatedRms = this.best.rms;
    this.simulated = { name: 'simulated', time, values, mark: modelMark(0), shown: true };
    const measured = { name: 'measured', time: samples.time, values: samples.measured, mark: kMeasured, shown: true };
    const [first, last] = scales.window;
    this.view = new TimeView(first, last, 1e-3 * (last - first));
    const { unit } = samples;
    const degrees = inDegrees(unit);
    this.plot = new TimePlot([measured, this.simulated], this.view, {
      name: 'simulated',
      sentence: () => `Measured and simulated ${quantityOf(unit)}; ${this.rmsWords()}.`,
      xLabel: 'time [s]',
      yLabel: () => `${quantityOf(unit)} [${unitText(degrees?.unit ?? unit)}]`,
      height: 260,
      factor: () => degrees?.factor ?? 1,
    });
    this.tell();
  }

  private rmsWords(): string {
    const words = (value: number): string => (Number.isNaN(value) ? '–' : valueWords(value, this.samples.unit));
    return `rms residual ${words(this.simulatedRms)}, with the fit ${words(this.best.rms)}`;
  }

  private tell(): void {
    const words = this.rmsWords();
    this.rms.textContent = words[0].toUpperCase() + words.slice(1);
  }

  private show({ time, values, rms }: Curve, problem?: unknown): void {
    Object.assign(this.simulated, { time, values });
    this.simulatedRms = rms;
    this.problem.className = problem instanceof Cancelled ? 'absent' : 'alarm';
    this.problem.textContent = problem === undefined ? '' : problemOf(problem).detail;
    this.tell();
    this.plot.chart.update();
  }

  /** The curve for the parameters that differ from the fit. */
  private async askFor(changed: Record<string, number>, signal: AbortSignal): Promise<Curve> {
    const { id, recording } = this.of;
    const answer = await readingsOf(id, { parameters: changed, model: this.fit.model, recording }, signal);
    const [time, values] = [answer.time_s, answer.value].map((numbers) => Float64Array.from(numbers));
    return { time, values, rms: answer.rms_residual };
  }

  private changed(): void {
    const moved = Object.entries(this.values).filter(([name, value]) => value !== this.estimates[name]);
    void this.curve.follow(Object.fromEntries(moved));
  }

  private slider(name: string): HTMLElement {
    const { unit } = this.fit.parameters[name];
    const estimate = this.estimates[name];
    const { least, most } = sliderRange(name, estimate, this.scales);
    const id = `slider-${name}`;
    const symbol = symbolOf(name, unit);
    const input = el('input', { type: 'range', id, min: '0', max: String(kSteps), step: '1', 'data-slider': name });
    const shown = el('output', { for: id });
    const stepOf = (value: number): string => String(Math.round((kSteps * (value - least)) / (most - least)));
    const set = (value: number): void => {
      this.values[name] = value;
      shown.textContent = valueWords(value, unit);
      input.setAttribute('aria-valuetext', shown.textContent);
    };
    const reset = (): void => {
      input.value = stepOf(estimate);
      set(estimate);
    };
    // The slider has steps; the step of the estimate means the estimate itself.
    input.addEventListener('input', () => {
      const isEstimate = input.value === stepOf(estimate);
      set(isEstimate ? estimate : least + (Number(input.value) / kSteps) * (most - least));
      this.changed();
    });
    this.resets.push(reset);
    reset();
    const label = el('label', { for: id }, wordsOf(name), symbol !== null && ' ', symbol !== null && symbolElement(symbol));
    return el('div', { class: 'slider' }, label, shown, input);
  }

  make(): HTMLElement {
    const sliders = el('div', { class: 'sliders' }, ...sliderNames(this.fit).map((name) => this.slider(name)));
    const reset = button('Back to the fit', () => {
      for (const one of this.resets) one();
      this.changed();
    });
    const legend = el(
      'ul',
      { class: 'legend' },
      el('li', {}, swatch(kMeasured), 'measured'),
      el('li', {}, swatch(modelMark(0)), 'simulated'),
    );
    const box = keyboardBox('Simulated swing', this.view, this.plot.chart.host);
    return section(
      'feel',
      'Feel the parameters',
      text('Move a slider and watch what the parameter does. The fit itself does not change.', 'quiet'),
      figure(
        'Drag to zoom; a double click shows all. The service computes the curve from the equation of the fit.',
        box,
        el('div', { class: 'bar' }, legend, navigationButtons(this.view)),
      ),
      el('div', { class: 'actions' }, reset, this.rms),
      this.problem,
      sliders,
    );
  }
}

/** The section for the shown law of a recording of fit `id`; null if there are no estimates or no series. */
export function slidersSection(one: OneRecording, id: string, signal: AbortSignal): HTMLElement | null {
  const fit = shownFitOf(one);
  const { samples } = one;
  const fitted = fit && samples?.models.get(fit.model)?.fitted;
  if (!fit || !samples || !fitted || fit.status === 'failed') return null;
  const scales = scalesOf(fit, samples);
  return scales && new SlidersSection({ id, recording: one.number - 1, signal }, fit, scales, samples, fitted).make();
}
