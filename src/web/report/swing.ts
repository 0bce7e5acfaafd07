// SPDX-License-Identifier: Apache-2.0
/** The swing with the fit, small enough for the first screen. */

import { el } from '../shared/dom';
import { swatch } from '../shared/marks';
import { inDegrees, quantityOf, unitText } from '../shared/units';
import { sharedView, type OneRecording } from './report';
import { bandWords, makeTraces } from './sections/fit_section';
import { TimePlot } from './time_plot';

const kNarrow = 560; // px
const kHeight = 340; // px
const kNarrowHeight = 190;

export const swingHeight = (): number => (window.innerWidth < kNarrow ? kNarrowHeight : kHeight);

/** Null without samples. It shows the same time range as the plots of section "fit". */
export function swingFigure(one: OneRecording): HTMLElement | null {
  const { samples } = one;
  if (!samples) return null;
  const traces = makeTraces(one, samples).fitted.filter((trace) => trace.shown);
  const degrees = inDegrees(samples.unit);
  const names = traces.map((trace) => trace.name).join(' and ');
  const plot = new TimePlot(traces, sharedView(one, samples), {
    name: 'swing',
    sentence: () => `The swing: ${names}, ${quantityOf(samples.unit)} over time.`,
    xLabel: 'time [s]',
    // The text beside the plot is in degrees, too.
    yLabel: () => `${quantityOf(samples.unit)} [${unitText(degrees?.unit ?? samples.unit)}]`,
    factor: () => degrees?.factor ?? 1,
    height: swingHeight(),
  });
  const legend = el('ul', { class: 'legend', 'aria-label': 'Curves' });
  for (const { name, mark } of traces) legend.append(el('li', {}, swatch(mark), name));
  const band = bandWords(traces);
  if (band !== '') legend.append(el('li', {}, band));
  return el('figure', { class: 'swing' }, legend, plot.chart.withButtons());
}
