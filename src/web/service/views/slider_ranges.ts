// SPDX-License-Identifier: Apache-2.0
/** The range of the slider of each parameter. */

import type { Fit } from '../../shared/result_types';

export interface SliderRange {
  least: number;
  most: number;
}

const kInertiaShare = 0.2; // of the estimate, to each side
const kFrictionTimes = 3; // the estimate
const kAngleShare = 0.5; // of the amplitude
const kPeriodShare = 0.25;

/** Over G in s for viscous, s² for drag, 1 for dry friction: torques of this size damp a swing visibly. */
const kTypical: Record<string, number> = { viscous: 0.01, coulomb: 0.01, drag: 0.005, stiction: 0.02 };

/**
 * The range around an estimate, so that its ends differ visibly. period: of small swings, s. amplitude: of the angle,
 * rad, in any unit of the readings. torque: the restoring torque in the units of the result.
 */
export function sliderRange(
  name: string,
  estimate: number,
  { period, amplitude, torque }: { period: number; amplitude: number; torque: number },
): SliderRange {
  const around = (reach: number): SliderRange => ({ least: estimate - reach, most: estimate + reach });
  switch (name) {
    case 'inertia':
      return around(kInertiaShare * estimate);
    case 'viscous':
    case 'coulomb':
    case 'drag':
    case 'stiction':
      return { least: 0, most: Math.max(kFrictionTimes * estimate, kTypical[name] * torque) };
    case 'stribeck_rate':
    case 'presliding_angle':
      return { least: 0.1 * estimate, most: kFrictionTimes * estimate };
    case 'asymmetry':
      return { least: -1, most: 1 };
    case 'release_time':
      return around(kPeriodShare * period);
    case 'initial_rate':
      return around((kAngleShare * amplitude * 2 * Math.PI) / period);
    case 'zero_drift':
    case 'bias_drift':
    case 'rate_scale':
    case 'radius':
      return around(kAngleShare * Math.abs(estimate) || 1e-3);
    default:
      return around(kAngleShare * amplitude);
  }
}

/** The parameters that have a slider: those that were not given by the user. */
export const sliderNames = (fit: Fit): string[] =>
  Object.keys(fit.parameters).filter((name) => !fit.parameters[name].fixed);
