// SPDX-License-Identifier: Apache-2.0
/** The measured swing, and the swing of the fitted law for parameters that the reader sets with sliders. */

import { shownFitOf, type OneRecording } from '../../report/report';
import { TimePlot, type Trace } from '../../report/time_plot';
import { button, el, symbolElement, text } from '../../shared/dom';
import { kMeasured, modelMark, swatch } from '../../shared/marks';
import { keyboardBox, navigationButtons } from '../../shared/navigation';
import type { Fit } from '../../shared/result_types';
import { significant } from '../../shared/rounding';
import type { Samples } from '../../shared/samples';
import { absent, figure, section } from '../../shared/section';
import { TimeView } from '../../shared/time_view';
import { inDegrees, quantityOf, spacedUnit, symbolOf, unitText, wordsOf } from '../../shared/units';
import { FittedSwing, rmsOf, type Values } from '../simulation/fitted_swing';
import { sliderNames, sliderRange } from './slider_ranges';

const kSteps = 400; // of a slider
const kMostSamples = 4000; // that a simulation computes
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
  private readonly time: Float64Array;
  private readonly measured: Float64Array;
  private readonly values: Values;
  private readonly best: number;
  private readonly simulated: Trace;
  private readonly plot: TimePlot;
  private readonly view: TimeView;
  private readonly rms = el('output', { class: 'slider-rms' });
  private readonly resets: (() => void)[] = [];
  private isWaiting = false;

  constructor(
    private readonly fit: Fit,
    private readonly motion: FittedSwing,
    private readonly samples: Samples,
  ) {
    this.time = thinned(samples.time);
    this.measured = thinned(samples.measured);
    this.values = { ...motion.estimates };
    const values = this.readings();
    this.best = rmsOf(this.measured, values);
    this.simulated = { name: 'simulated', time: this.time, values, mark: modelMark(0), shown: true };
    const measured = { name: 'measured', time: samples.time, values: samples.measured, mark: kMeasured, shown: true };
    const [first, last] = [this.time[0], this.time[this.time.length - 1]];
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

  private readings(): Float64Array {
    return this.motion.readings(this.values, this.time) ?? this.time.map(() => NaN);
  }

  private rmsWords(): string {
    const words = (value: number): string => (Number.isNaN(value) ? '–' : valueWords(value, this.samples.unit));
    return `rms residual ${words(rmsOf(this.measured, this.simulated.values))}, with the fit ${words(this.best)}`;
  }

  private tell(): void {
    const words = this.rmsWords();
    this.rms.textContent = words[0].toUpperCase() + words.slice(1);
  }

  /** Simulates at the next frame, once for several changes. */
  private changed(): void {
    if (this.isWaiting) return;
    this.isWaiting = true;
    requestAnimationFrame(() => {
      this.isWaiting = false;
      this.simulated.values = this.readings();
      this.tell();
      this.plot.chart.update();
    });
  }

  private slider(name: string): HTMLElement {
    const { unit } = this.fit.parameters[name];
    const estimate = this.motion.estimates[name];
    const { least, most } = sliderRange(name, estimate, this.motion.scales(this.time));
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
        'Drag to zoom; a double click shows all. The curve is computed in this page from the equation of the fit.',
        box,
        el('div', { class: 'bar' }, legend, navigationButtons(this.view)),
      ),
      el('div', { class: 'actions' }, reset, this.rms),
      sliders,
    );
  }
}

/** The section for the shown law; null if there is no fit or no series. */
export function slidersSection(one: OneRecording): HTMLElement | null {
  const fit = shownFitOf(one);
  const { samples } = one;
  const fitted = fit && samples?.models.get(fit.model)?.fitted;
  if (!fit || !samples || !fitted || fit.status === 'failed') return null;
  const motion = FittedSwing.of(one.data, fit, samples.unit);
  if (motion?.agreesWith(thinned(samples.time), thinned(fitted))) return new SlidersSection(fit, motion, samples).make();
  return section(
    'feel',
    'Feel the parameters',
    absent('This fit has a sensor, a law or a correction of the readings that the page cannot simulate.'),
  );
}
