// SPDX-License-Identifier: Apache-2.0
/** Whether inertia and friction stay constant during the recording. */

import { Chart, padded } from '../../shared/chart';
import { append, el } from '../../shared/dom';
import { sentence } from '../../shared/prose';
import type { AmplitudeWindow, Constancy, Num } from '../../shared/result_types';
import { significant } from '../../shared/rounding';
import { extent } from '../../shared/samples';
import { figure } from '../../shared/section';
import { inDegrees, unitText, wordsOf } from '../../shared/units';
import { shownFitOf, type OneRecording, type RecordedFit } from '../report';
import { toldPart } from '../told';

type Amplitude = NonNullable<Constancy['amplitude']>;

/** Key of a parameter of a window, and key of its standard error. */
type Value = (window: AmplitudeWindow) => [Num, Num];

const kDegrees = inDegrees('rad')?.factor ?? 1; // in a radian

function windowChart(
  name: string,
  unit: string,
  windows: AmplitudeWindow[],
  value: Value,
  whole: Num,
): HTMLElement | null {
  const used = windows.filter((w) => w.amplitude_rad !== null && value(w)[0] !== null);
  if (used.length < 2) return null;
  const x = used.map((w) => kDegrees * (w.amplitude_rad as number));
  const y = used.map((w) => value(w)[0] as number);
  const error = used.map((w) => value(w)[1] ?? 0);
  const [low, high] = [y.map((v, i) => v - error[i]), y.map((v, i) => v + error[i])];
  const words = `${wordsOf(name)} in ${used.length} windows against the amplitude, with standard errors; the dashed line is the fit of the whole recording`;
  const chart = new Chart({
    name: `${name}_by_amplitude`,
    sentence: () =>
      `${words}. From ${significant(y[0], 4)} at ${significant(x[0], 3)}° to ${significant(y[y.length - 1], 4)} at ${significant(x[x.length - 1], 3)}°.`,
    xLabel: 'amplitude [°]',
    yLabel: () => `${wordsOf(name)}${unitText(unit) ? ` [${unitText(unit)}]` : ''}`,
    xRange: () => padded(extent([x]), 0.08),
    yRange: () => padded(extent([low, high, whole === null ? [] : [whole]]), 0.12),
    draw: (painter) => {
      if (whole !== null) painter.horizontal(whole, 'rule', [5, 4]);
      painter.errorBars(x, low, high, 'curve-1');
      painter.dots(x, y, 'curve-1', 3.2);
    },
    height: 230,
  });
  return figure(sentence(words), chart.withButtons());
}

/** Inertia and the fitted friction parameter against the amplitude. */
function windowCharts(fit: RecordedFit, { windows, trends }: Amplitude): HTMLElement {
  const friction = trends.find((trend) => trend.parameter !== 'inertia')?.parameter;
  const unitOf = (name: string): string =>
    fit.parameters[name]?.unit ?? trends.find((trend) => trend.parameter === name)?.unit ?? '1';
  const whole = (name: string): Num => fit.parameters[name]?.estimate ?? null;
  const charts = el('div', { class: 'pair' });
  const inertia: Value = (window) => [window.inertia, window.inertia_std_error];
  append(charts, [windowChart('inertia', unitOf('inertia'), windows, inertia, whole('inertia'))]);
  const free: Value = (window) => [window.friction, window.friction_std_error];
  if (friction) append(charts, [windowChart(friction, unitOf(friction), windows, free, whole(friction))]);
  return charts;
}

export function constancySection(one: OneRecording): HTMLElement | null {
  const fit = shownFitOf(one);
  const amplitude = fit?.constancy?.amplitude;
  const charts = fit && amplitude && amplitude.windows.length > 0 ? [windowCharts(fit, amplitude)] : [];
  return toldPart(one.report, 'constancy', 'Constancy', charts);
}
