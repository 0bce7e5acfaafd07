// SPDX-License-Identifier: Apache-2.0
import { expect, test } from 'vitest';

import type { Fit, Recording } from '../../shared/result_types';
import { FittedSwing } from './fitted_swing';

const kTimes = Float64Array.from({ length: 400 }, (_time, k) => 0.01 * k);

/** A swing of 0.3 rad whose sensor has these parameters and this unit. */
function swingOf(sensor: Record<string, number>, unit: string): FittedSwing {
  const start = { inertia: 0.04, viscous: 0, release_angle: 0.3, release_time: 0 };
  const parameters = Object.fromEntries(
    Object.entries({ ...start, ...sensor }).map(([name, estimate]) => [name, { estimate }]),
  );
  const fit = { model: 'viscous', parameters, derived: { natural_frequency: { estimate: 5 } } };
  const recording = { clock_scale: 1, window_s: [0, 4] };
  return FittedSwing.of(recording as unknown as Recording, fit as unknown as Fit, unit)!;
}

const rangeOf = (values: Float64Array): number => Math.max(...values) - Math.min(...values);

test.each([
  ['px', { radius: 400, pivot_x: 960, zero_angle: 0 }, 'px', 2 * 400 * Math.sin(0.3)],
  ['m', { radius: 0.5, pivot_x: 0, zero_angle: 0 }, 'm', 2 * 0.5 * Math.sin(0.3)],
  ['rates', { rate_bias: 0.01 }, 'rad/s', 2 * 5 * 2 * Math.sin(0.15)], // energy: ω = 2 ω_n sin(θ/2)
  ['rates in counts', { rate_scale: 1000, rate_bias: 0 }, 'counts', 2000 * 5 * 2 * Math.sin(0.15)],
  ['angles', { zero_angle: 0.1 }, 'rad', 0.6],
])('sliders use the amplitude of the angle, also for readings in %s', (_name, sensor, unit, range) => {
  const swing = swingOf(sensor as unknown as Record<string, number>, unit);
  expect(rangeOf(swing.readings(swing.estimates, kTimes)!) / range).toBeCloseTo(1, 2);
  expect(swing.scales(kTimes).amplitude).toBeCloseTo(0.3, 3);
});
