// SPDX-License-Identifier: Apache-2.0
/** The readings of a fitted pendulum for other values of its parameters. */

import type { Fit, Recording } from '../../shared/result_types';
import { extent } from '../../shared/samples';
import { isTorque, lawOf, type Law } from './laws';
import { swing, type Motion, type Start } from './swing';

/** Values of parameters by name, in the units of the result. */
export type Values = Record<string, number>;

const kStarts = ['release_angle', 'release_time', 'initial_angle', 'initial_rate'];
const kSensors = ['zero_angle', 'zero_drift', 'rate_bias', 'bias_drift', 'rate_scale', 'pivot_x', 'radius'];

export class FittedSwing {
  private constructor(
    private readonly law: Law,
    /** The estimates. */
    readonly estimates: Values,
    /** The restoring torque, in the units of the result. */
    private readonly torque: number,
    /** True seconds in a second of the recording, and its first used sample, s. */
    private readonly clock: number,
    private readonly first: number,
    private readonly isRate: boolean,
  ) {}

  /** null: the page does not know the law or the sensor, or an estimate is missing. */
  static of({ clock_scale: clock, window_s: window }: Recording, fit: Fit, unit: string): FittedSwing | null {
    const law = lawOf(fit.model);
    const frequency = fit.derived.natural_frequency?.estimate;
    const estimates: Values = {};
    for (const [name, { estimate }] of Object.entries(fit.parameters)) {
      if (estimate === null || !law) return null;
      if (!['inertia', ...law.names, ...kStarts, ...kSensors].includes(name)) return null;
      estimates[name] = estimate;
    }
    if (!law || !frequency || !['inertia', ...law.names].every((name) => name in estimates)) return null;
    const isRate = unit === 'rad/s' || 'rate_scale' in estimates;
    return new FittedSwing(law, estimates, estimates.inertia * frequency ** 2, clock, window[0], isRate);
  }

  /**
   * Sizes that the ranges of sliders depend on: period of small swings in s, amplitude of the simulated angle in rad.
   * The readings may be rates or pixels, so they do not show the angle.
   */
  scales(times: Float64Array): { period: number; amplitude: number; torque: number } {
    const motion = this.motion(this.estimates, times);
    const [low, high] = (motion && extent([motion.angle])) ?? [-1, 1];
    const period = 2 * Math.PI * Math.sqrt(this.estimates.inertia / this.torque);
    return { period, amplitude: 0.5 * (high - low), torque: this.torque };
  }

  private start(values: Values): Start {
    const { release_angle: held, release_time: time = 0, initial_angle: angle = 0, initial_rate: rate = 0 } = values;
    return held === undefined
      ? { time: this.clock * this.first, angle, rate }
      : { time: this.clock * time, angle: held, rate: 0 };
  }

  private reading({ angle, rate }: Motion, i: number, time: number, values: Values): number {
    const { zero_angle: zero = 0, zero_drift: drift = 0, rate_bias: bias = 0, bias_drift: ofBias = 0 } = values;
    const since = this.clock * (time - this.first);
    if (this.isRate) return (values.rate_scale ?? 1) * rate[i] + bias + ofBias * since;
    const shown = angle[i] + zero + drift * since;
    return 'radius' in values ? (values.pivot_x ?? 0) + values.radius * Math.sin(shown) : shown;
  }

  private motion(values: Values, times: Float64Array): Motion | null {
    const friction = this.law.names.map((name) => (isTorque(name) ? values[name] / this.torque : values[name]));
    const pendulum = { law: this.law, inertia: values.inertia / this.torque, friction };
    return swing(pendulum, this.start(values), times.map((time) => this.clock * time));
  }

  /** The readings at increasing times of the recording, s; null if these values give no motion. */
  readings(values: Values, times: Float64Array): Float64Array | null {
    const motion = this.motion(values, times);
    return motion && times.map((time, i) => this.reading(motion, i, time, values));
  }

  /**
   * Whether the readings at the estimates are those of the program, to a thousandth of their range. They are not if it
   * also fitted what this page does not simulate, such as steps of the zero.
   */
  agreesWith(times: Float64Array, fitted: Float64Array): boolean {
    const own = this.readings(this.estimates, times);
    if (!own) return false;
    let [low, high, worst] = [Infinity, -Infinity, 0];
    for (let i = 0; i < times.length; ++i) {
      if (Number.isNaN(fitted[i])) continue;
      low = Math.min(low, fitted[i]);
      high = Math.max(high, fitted[i]);
      worst = Math.max(worst, Math.abs(own[i] - fitted[i]));
    }
    return worst <= 1e-3 * (high - low);
  }
}

/** Root of the mean square of measured - simulated; NaN without a sample. */
export function rmsOf(measured: Float64Array, simulated: Float64Array): number {
  let [sum, count] = [0, 0];
  for (let i = 0; i < measured.length; ++i) {
    const difference = measured[i] - simulated[i];
    if (Number.isNaN(difference)) continue;
    sum += difference * difference;
    ++count;
  }
  return Math.sqrt(sum / count);
}

