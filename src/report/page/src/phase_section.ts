// SPDX-License-Identifier: Apache-2.0
/** Phase portrait of the fitted motion. */

import { Chart, padded } from './chart';
import { modelMark } from './marks';
import { centralDifferences, thinned } from './phase';
import { rankOf, shownFit, type Report } from './report';
import { significant } from './rounding';
import { extent, medianInterval } from './samples';
import { absent, figure, section } from './section';
import { fittedMotion } from './trajectory';
import type { Fit } from './types';
import { unitText } from './units';
import { aliased } from './validation_section';
import { zeroOf } from './envelope';

const kMostPoints = 20_000;

/** θ and θ′ of the fitted motion; by the equation where samples cannot tell: of a rate, slow, or with gaps. */
function portrait(report: Report, fit: Fit): { angle: Float64Array; rate: Float64Array } | null {
  const { samples, result } = report;
  const fitted = samples?.models.get(fit.model)?.fitted;
  const gaps = result.data.sampling?.gaps ?? 0;
  const motion = fittedMotion(fit, result.data.window_s, result.data.clock_scale || 1);
  const sampled = samples && samples.unit !== 'rad/s' && fitted && !aliased(report);
  if (sampled && (gaps === 0 || !motion)) {
    const zero = zeroOf(fit.parameters, result.data.window_s[0]);
    const angle = fitted.map((value, i) => value - zero(samples.time[i]));
    const rate = centralDifferences(samples.time, angle, 3 * medianInterval(samples.time));
    return { angle: thinned(angle, kMostPoints), rate: thinned(rate, kMostPoints) };
  }
  return motion && { angle: thinned(motion.angle, kMostPoints), rate: thinned(motion.rate, kMostPoints) };
}

export function phaseSection(report: Report): HTMLElement {
  const fit = shownFit(report);
  const path = fit && report.samples ? portrait(report, fit) : null;
  const angles = path && extent([path.angle]);
  const rates = path && extent([path.rate]);
  if (!fit || !path || !angles || !rates) {
    return section(
      'phase',
      'Phase portrait',
      absent('There is no fitted angle to draw against its rate: the sensor gives no angle, or there is no fit.'),
    );
  }
  const start = fit.parameters.release_angle ?? fit.parameters.initial_angle;
  const unit = unitText(start?.unit ?? 'rad');
  const most = (range: readonly [number, number]): number => Math.max(-range[0], range[1]);
  const chart = new Chart({
    sentence: () =>
      `Rate against angle of the fitted motion: a spiral from angles up to ${significant(most(angles), 3)} ${unit} ` +
      `and rates up to ${significant(most(rates), 3)} ${unit}/s towards rest at the origin.`,
    xLabel: `angle from the zero [${unit}]`,
    yLabel: () => `rate [${unit}/s]`,
    xRange: () => padded([-most(angles), most(angles)]),
    yRange: () => padded([-most(rates), most(rates)]),
    draw: (painter) => {
      painter.horizontal(0, 'rule');
      painter.vertical(0, 'rule');
      painter.line(path.angle, path.rate, { ...modelMark(rankOf(report.result, report.shown)), dash: [], width: 1 });
    },
    height: 340,
  });
  const element = section('phase', 'Phase portrait', figure(`Fitted ${fit.model}, angle against rate.`, chart.host));
  element.classList.add('half');
  return element;
}
