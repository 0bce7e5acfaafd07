// SPDX-License-Identifier: Apache-2.0
/** Phase portrait of the fitted motion. */

import { Chart, padded } from '../../shared/chart';
import { modelMark } from '../../shared/marks';
import { significant } from '../../shared/rounding';
import { extent, medianInterval } from '../../shared/samples';
import { absent, figure, section } from '../../shared/section';
import { inShownUnit, shownUnit } from '../../shared/units';
import { zeroOf } from '../envelope';
import { centralDifferences, thinned } from '../phase';
import { isAliased, rankOf, shownFitOf, type OneRecording, type RecordedFit } from '../report';

const kMostPoints = 20_000;

/** Angle and rate of the fitted motion. Where the series has no motion, the samples show it: their fitted values are used. */
function portrait(one: OneRecording, fit: RecordedFit): { angle: Float64Array; rate: Float64Array } | null {
  const { samples, data } = one;
  const fitted = samples?.models.get(fit.model)?.fitted;
  const motion = samples?.motions.get(fit.model);
  if (motion) return { angle: thinned(motion.angle, kMostPoints), rate: thinned(motion.rate, kMostPoints) };
  if (!samples || !fitted || samples.unit === 'rad/s' || isAliased(one)) return null;
  const zero = zeroOf(fit.parameters, data.window_s[0]);
  const angle = fitted.map((value, i) => value - zero(samples.time[i]));
  const rate = centralDifferences(samples.time, angle, 3 * medianInterval(samples.time));
  return { angle: thinned(angle, kMostPoints), rate: thinned(rate, kMostPoints) };
}

export function phaseSection(one: OneRecording): HTMLElement {
  const { report } = one;
  const fit = shownFitOf(one);
  const own = (fit?.parameters.release_angle ?? fit?.parameters.initial_angle)?.unit ?? 'rad';
  const found = fit && one.samples ? portrait(one, fit) : null;
  const path = found && { angle: inShownUnit(found.angle, own), rate: inShownUnit(found.rate, own) };
  const angles = path && extent([path.angle]);
  const rates = path && extent([path.rate]);
  if (!fit || !path || !angles || !rates) {
    return section(
      'phase',
      'Phase portrait',
      absent('There is no fitted angle to draw against its rate: the sensor gives no angle, or there is no fit.'),
    );
  }
  const { unit } = shownUnit(own);
  const most = (range: readonly [number, number]): number => Math.max(-range[0], range[1]);
  const chart = new Chart({
    name: 'phase_portrait',
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
  const element = section('phase', 'Phase portrait', figure(`Fitted ${fit.model}, angle against rate.`, chart.withButtons()));
  element.classList.add('half');
  return element;
}
