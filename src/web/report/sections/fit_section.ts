// SPDX-License-Identifier: Apache-2.0
/** Measured and fitted readings of all models, with their residuals below. */

import { choice, details, el, text, toggle } from '../../shared/dom';
import { kMeasured, modelMark, swatch } from '../../shared/marks';
import { keyboardBox, navigationButtons } from '../../shared/navigation';
import type { Painter } from '../../shared/painter';
import { capital } from '../../shared/prose';
import { fixed, significant } from '../../shared/rounding';
import { extent, lowerBound, rootMeanSquare, type Samples } from '../../shared/samples';
import { absent, figure, section } from '../../shared/section';
import { table } from '../../shared/table';
import type { TimeView } from '../../shared/time_view';
import { inDegrees, quantityOf, shownUnit, unitText, withUnit } from '../../shared/units';
import { rankOf, sharedView, shownFitOf, type OneRecording, type RecordedFit } from '../report';
import { SwingAnimation, swingsOf } from '../swing_animation';
import { TimePlot, type Trace } from '../time_plot';

/** A unit for residuals, and its label. */
interface ResidualUnit {
  value: string;
  label: string;
  axis: string;
  factor: number;
}

/** In degrees, as the text of the report. */
const axisLabel = (unit: string): string => `${quantityOf(unit)} [${unitText(inDegrees(unit)?.unit ?? unit)}]`;

const kFewPerPeriod = 12; // samples: with fewer, straight lines between them do not look like the motion

/** The fitted readings of fit i: at the samples, or as a smooth curve where samples are few in a period. */
export function fittedTrace({ report, data }: OneRecording, samples: Samples, fit: RecordedFit, i: number): Trace | null {
  const fitted = samples.models.get(fit.model)?.fitted;
  if (!fitted) return null;
  const trace: Trace = {
    name: fit.model,
    time: samples.time,
    values: fitted,
    mark: modelMark(rankOf(report.result, i)),
    shown: i === report.shown,
    errors: samples.models.get(fit.model)?.fittedError,
  };
  const perPeriod = data.sampling?.samples_per_period ?? Infinity;
  if (perPeriod === null || perPeriod >= kFewPerPeriod) return trace;
  const motion = samples.motions.get(fit.model);
  return motion ? { ...trace, time: motion.time, values: motion.reading, errors: null } : trace;
}

function residualUnits(one: OneRecording, samples: Samples): ResidualUnit[] {
  const fit = shownFitOf(one);
  const own = unitText(samples.unit);
  const units: ResidualUnit[] = [{ value: 'own', label: own, axis: `residual [${own}]`, factor: 1 }];
  const degrees = inDegrees(samples.unit);
  if (degrees)
    units.unshift({ value: 'degrees', label: degrees.unit, axis: `residual [${degrees.unit}]`, factor: degrees.factor });
  const sigma = withUnit(fit?.noise, 'sigma');
  if (sigma) units.push({ value: 'sigma', label: 'σ', axis: 'residual [σ]', factor: 1 / sigma });
  const level = withUnit(one.data, 'resolution');
  if (level) units.push({ value: 'counts', label: 'counts', axis: 'residual [counts]', factor: 1 / level });
  return units;
}

function legend(traces: Trace[], change: (trace: Trace, on: boolean) => void): HTMLElement {
  const box = el('div', { class: 'legend', role: 'group', 'aria-label': 'Curves shown' });
  for (const trace of traces) {
    box.append(toggle([swatch(trace.mark), trace.name], trace.shown, (on) => change(trace, on)));
  }
  return box;
}

/** "t = 3.42 s: measured 7.05, coulomb 6.88 °" */
function readout(samples: Samples, traces: Trace[], time: number | null): string {
  if (time === null) return '\u00a0';
  const i = Math.min(samples.time.length - 1, lowerBound(samples.time, time));
  const near = i > 0 && time - samples.time[i - 1] < samples.time[i] - time ? i - 1 : i;
  const { unit, factor } = shownUnit(samples.unit);
  const values = traces
    .filter((trace) => trace.shown && trace.time === samples.time)
    .map((trace) => `${trace.name} ${significant(factor * trace.values[near], 4)}`);
  return `t = ${fixed(samples.time[near], 3)} s: ${values.join(', ')} ${unit}`;
}

/** Table of about 50 samples in the visible range. */
function sampleTable(samples: Samples, traces: Trace[], view: TimeView): HTMLElement {
  const [from, to] = view.current;
  const [first, end] = [lowerBound(samples.time, from), lowerBound(samples.time, to + 1e-12)];
  const stride = Math.max(1, Math.ceil((end - first) / 50));
  const shown = traces.filter((trace) => trace.time === samples.time);
  const { unit, factor } = shownUnit(samples.unit);
  const rows: string[][] = [];
  for (let i = first; i < end; i += stride) {
    rows.push([fixed(samples.time[i], 3), ...shown.map((trace) => significant(factor * trace.values[i], 4))]);
  }
  const columns = [
    { head: 't [s]' },
    ...shown.map((trace) => ({ head: `${trace.name} [${unit}]`, kind: 'number' as const })),
  ];
  return table(`Every ${stride === 1 ? '' : `${stride}th `}sample of the range shown`, columns, rows);
}

const kVisible = 1 / 300; // of the height of a plot: a pixel
const kNormal95 = 1.96;

/** What the band around the fitted curve is; empty if none can be seen. */
export function bandWords(traces: Trace[]): string {
  const range = extent(traces.filter((trace) => trace.shown).map((trace) => trace.values));
  const widest = Math.max(0, ...traces.map(({ shown, errors }) => (shown && errors ? (extent([errors])?.[1] ?? 0) : 0)));
  return range && 2 * kNormal95 * widest > kVisible * (range[1] - range[0])
    ? 'band: 95 % confidence interval of the curve'
    : '';
}

export function makeTraces(one: OneRecording, samples: Samples): { fitted: Trace[]; residual: Trace[] } {
  const fitted: Trace[] = [
    { name: 'measured', time: samples.time, values: samples.measured, mark: kMeasured, shown: true },
  ];
  const residual: Trace[] = [];
  const { result, shown } = one.report;
  one.fits.forEach((fit, i) => {
    const trace = fittedTrace(one, samples, fit, i);
    if (trace) fitted.push(trace);
    const values = samples.models.get(fit.model)?.residual;
    if (!values) return;
    const mark = { ...modelMark(rankOf(result, i)), points: true };
    residual.push({ name: fit.model, time: samples.time, values, mark, shown: i === shown });
  });
  return { fitted, residual };
}

const inWords = ([from, to]: readonly [number, number]): string =>
  `from ${significant(from, 4)} to ${significant(to, 4)} s`;

const names = (traces: Trace[]): string =>
  traces
    .filter((trace) => trace.shown)
    .map((trace) => trace.name)
    .join(' and ') || 'nothing';

class FitPlots {
  readonly view: TimeView;
  private readonly traces: { fitted: Trace[]; residual: Trace[] };
  private readonly units: ResidualUnit[];
  private unit: ResidualUnit;
  private readonly main: TimePlot;
  private readonly below: TimePlot | null;
  /** Noise of a sample in the unit of the readings. */
  private readonly sigma: number | null;
  private readonly line = el('p', { class: 'readout', 'aria-hidden': 'true' }, '\u00a0');

  constructor(
    private readonly one: OneRecording,
    private readonly samples: Samples,
  ) {
    this.view = sharedView(one, samples);
    this.sigma = withUnit(shownFitOf(one)?.noise, 'sigma') ?? null;
    this.traces = makeTraces(one, samples);
    this.units = residualUnits(one, samples);
    this.unit = this.units[0];
    this.main = this.mainPlot();
    this.below = this.traces.residual.length > 0 ? this.residualPlot() : null;
  }

  private onCursor = (time: number | null): void => {
    this.line.textContent = readout(this.samples, this.traces.fitted, time);
  };

  private mainPlot(): TimePlot {
    const degrees = inDegrees(this.samples.unit);
    return new TimePlot(this.traces.fitted, this.view, {
      name: 'fit',
      sentence: () =>
        `${names(this.traces.fitted)}: ${quantityOf(this.samples.unit)} over time ${inWords(this.view.current)}.`,
      xLabel: '',
      yLabel: () => axisLabel(this.samples.unit),
      factor: () => degrees?.factor ?? 1,
      right: degrees && { label: `[${unitText(this.samples.unit)}]`, factor: 1 / degrees.factor },
      aligned: degrees ? 'with right axis' : 'without',
      height: 330,
      onCursor: this.onCursor,
    });
  }

  private residualPlot(): TimePlot {
    const size = (): string => {
      const shown = this.traces.residual.find((trace) => trace.shown);
      return shown
        ? `, ${significant(this.unit.factor * rootMeanSquare(shown.values), 3)} ${this.unit.label} root mean square`
        : '';
    };
    const wide = inDegrees(this.samples.unit) !== null;
    return new TimePlot(this.traces.residual, this.view, {
      name: 'residuals',
      every: true,
      sentence: () =>
        `Residuals (measured minus fitted) of ${names(this.traces.residual)} over time ${inWords(this.view.current)}${size()}.`,
      xLabel: 'time [s]',
      yLabel: () => this.unit.axis,
      aligned: wide ? 'with right axis' : 'without',
      height: 190,
      symmetric: true,
      factor: () => this.unit.factor,
      behind: (painter: Painter) => this.noise((reach) => painter.band(-reach, reach, 'band')),
      inFront: (painter: Painter) => {
        this.noise((reach) => [-reach, reach].forEach((end) => painter.horizontal(end, 'ink', [4, 3])));
        painter.horizontal(0, 'rule');
      },
      onCursor: this.onCursor,
    });
  }

  /** Calls `draw` with the noise σ in the unit of the residuals, if it is known. */
  private noise(draw: (reach: number) => void): void {
    if (this.sigma !== null) draw(this.unit.factor * this.sigma);
  }

  /** Shows or hides a model and its residuals. */
  private change = (trace: Trace, on: boolean): void => {
    this.main.setShown(trace, on);
    const residual = this.traces.residual.find((other) => other.name === trace.name);
    if (residual) this.below?.setShown(residual, on);
  };

  private setUnit = (value: string): void => {
    this.unit = this.units.find((unit) => unit.value === value) ?? this.units[0];
    this.below?.chart.rebuild();
  };

  /** A button that shows the pendulum beside the plots; null if no motion is known. */
  private swingButton(panel: HTMLElement): HTMLElement | null {
    const fitted = modelMark(rankOf(this.one.report.result, this.one.report.shown));
    const swings = swingsOf(this.one, this.samples, kMeasured, fitted);
    if (swings.length === 0) return null;
    let animation: SwingAnimation | null = null;
    return toggle(['Watch it swing'], false, (on) => {
      animation?.stop();
      const scale = this.one.data.clock_scale || 1;
      animation = on ? new SwingAnimation(swings, this.view, scale, (time) => this.main.chart.pointAt(time)) : null;
      panel.replaceChildren(...(animation ? [animation.element] : []));
      if (!on) this.main.chart.pointAt(null);
    });
  }

  element(): HTMLElement {
    const panel = el('div', { class: 'swing-panel' });
    const curves = legend(this.traces.fitted, this.change);
    const watch = this.swingButton(panel);
    if (watch) curves.append(watch);
    const bar = el('div', { class: 'bar' }, curves, navigationButtons(this.view));
    const box = keyboardBox('Measured and fitted, and residuals', this.view, this.main.chart.withButtons());
    if (this.below)
      box.append(
        el(
          'div',
          { class: 'bar residual' },
          el('h3', {}, 'Residuals: measured − fitted'),
          choice('in', this.units, this.unit.value, this.setUnit),
        ),
        this.below.chart.withButtons(),
      );
    box.append(this.line);
    const hint = 'Drag to zoom. Double-click to show all. Shift and drag, or drag with a finger, to move.';
    const many = this.samples.time.length > 2000 && 'If a column of pixels has many samples, its smallest and largest are drawn.';
    const band = bandWords(this.traces.fitted);
    const words = [
      this.sigma !== null && 'Band of the residuals: ±σ, the noise of a sample.',
      band !== '' && `${capital(band)}.`,
      many,
    ].flatMap((part) => (part ? [` ${part}`] : []));
    const caption = el('span', {}, el('span', { class: 'hint' }, hint), ...words);
    return el(
      'div',
      {},
      el('div', { class: 'beside-swing' }, figure(caption, box, bar), panel),
      details('Samples as a table', () => sampleTable(this.samples, this.traces.fitted, this.view)),
    );
  }
}

export function fitSection(one: OneRecording): HTMLElement {
  const title = 'Measured and fitted';
  const { samples, fits } = one;
  if (!samples)
    return section('fit', title, absent('The samples are not part of this report, so there is nothing to draw.'));
  const onlyMeasured = fits.every((fit) => !samples.models.get(fit.model)?.fitted);
  return section(
    'fit',
    title,
    onlyMeasured && text('There is no fitted motion to compare with.', 'absent'),
    new FitPlots(one, samples).element(),
  );
}
