// SPDX-License-Identifier: Apache-2.0
/** The range of the slider of each parameter. */

import type { Fit, Num } from '../../shared/result_types';
import { extent, type Samples } from '../../shared/samples';

export interface SliderRange {
  least: number;
  most: number;
}

/** Sizes that the ranges depend on. */
export interface Scales {
  /** Of small swings, s. */
  period: number;
  /** Of the angle, in its unit. The readings may be rates or pixels, so they need not show it. */
  amplitude: number;
  /** Half the range of the readings, in their unit. */
  reading: number;
  /** The restoring torque in the units of the result. */
  torque: number;
  /** First and last time, s on the file's clock. */
  window: [number, number];
}

const kInertiaShare = 0.2; // of the estimate, to each side
const kTimes = 3; // the estimate
const kShare = 0.5; // of the amplitude or the estimate
const kPeriodShare = 0.25;

/** Over G in s for viscous, s² for drag, 1 for dry friction: torques of this size damp a swing visibly. */
const kTypical: Record<string, number> = {
  viscous: 0.01,
  coulomb: 0.01,
  drag: 0.005,
  stiction: 0.02,
  load_friction: 0.01,
};

/** The range around an estimate, so that its ends differ visibly. */
export function sliderRange(name: string, estimate: number, scales: Scales): SliderRange {
  const around = (reach: number): SliderRange => ({ least: estimate - reach, most: estimate + reach });
  const { period, amplitude, reading, torque, window } = scales;
  if (name in kTypical) return { least: 0, most: Math.max(kTimes * estimate, kTypical[name] * torque) };
  switch (name) {
    case 'inertia':
      return around(kInertiaShare * estimate);
    case 'asymmetry':
      return { least: -1, most: 1 };
    case 'release_angle':
    case 'initial_angle':
    case 'zero_angle':
    case 'axis':
    case 'hysteresis':
      return around(kShare * amplitude);
    case 'release_time': {
      const { least, most } = around(kPeriodShare * period);
      return { least: Math.max(least, window[0]), most: Math.min(most, window[1]) };
    }
    case 'initial_rate':
      return around((kShare * amplitude * 2 * Math.PI) / period);
    case 'rate_bias':
    case 'acceleration_bias':
    case 'pivot_x':
    case 'pivot_y':
      return around(kShare * reading);
    case 'zero_drift':
    case 'bias_drift':
    case 'rate_scale':
    case 'acceleration_scale':
    case 'radius':
      return around(kShare * Math.abs(estimate) || 1e-3);
    default: // of friction, such as a reference rate
      return estimate > 0 ? { least: 0.1 * estimate, most: kTimes * estimate } : around(Math.abs(estimate) || 1);
  }
}

/** The parameters that have a slider: those that were not given by the user. */
export const sliderNames = (fit: Fit): string[] =>
  Object.keys(fit.parameters).filter((name) => !fit.parameters[name].fixed);

const halfRange = (values: Float64Array | null | undefined): number | null => {
  const range = values && extent([values]);
  return range && range[1] > range[0] ? 0.5 * (range[1] - range[0]) : null;
};

/** The scales of a fit; null if it does not have them. */
export function scalesOf(fit: Fit, { time, measured, models, motions }: Samples): Scales | null {
  const estimateOf = (quantity: { estimate: Num } | undefined): number => quantity?.estimate ?? NaN;
  const period = estimateOf(fit.derived.small_angle_period);
  const torque = estimateOf(fit.parameters.inertia) * estimateOf(fit.derived.natural_frequency) ** 2;
  const reading = halfRange(models.get(fit.model)?.fitted) ?? halfRange(measured) ?? 1;
  const amplitude = halfRange(motions.get(fit.model)?.angle) ?? reading;
  if (!(period > 0 && torque > 0)) return null;
  return { period, amplitude, reading, torque, window: [time[0], time[time.length - 1]] };
}
