// SPDX-License-Identifier: Apache-2.0
import { expect, test } from 'vitest';

import type { Fit } from '../../shared/result_types';
import type { Motion, Samples } from '../../shared/samples';
import { scalesOf, sliderRange, type Scales } from './slider_ranges';

const kScales: Scales = { period: 1.3, amplitude: 0.5, reading: 200, torque: 1.8, window: [0, 20] };
const kFriction = ['viscous', 'coulomb', 'drag', 'stiction', 'load_friction'];
const kStart = ['release_time', 'release_angle', 'initial_angle', 'initial_rate'];
const kSensor = ['zero_angle', 'rate_bias', 'zero_drift', 'hysteresis', 'radius', 'pivot_x', 'axis', 'acceleration_scale'];

test('every range contains its estimate and is not empty, also for an estimate of 0', () => {
  for (const name of ['inertia', ...kFriction, 'stribeck_rate', 'asymmetry', 'of_a_new_law', ...kStart, ...kSensor]) {
    for (const estimate of name === 'inertia' || name === 'stribeck_rate' ? [0.08] : [0, 0.08]) {
      const { least, most } = sliderRange(name, estimate, kScales);
      expect(most, name).toBeGreaterThan(least);
      expect(least, name).toBeLessThanOrEqual(estimate);
      expect(most, name).toBeGreaterThanOrEqual(estimate);
    }
  }
});

test('inertia stays positive, friction never drives the motion, and the release stays in the recording', () => {
  for (const name of ['inertia', 'of_a_new_law']) expect(sliderRange(name, 0.08, kScales).least).toBeGreaterThan(0);
  for (const name of kFriction) expect(sliderRange(name, 0.01, kScales).least).toBe(0);
  expect(sliderRange('release_time', 0.1, kScales).least).toBe(0);
  expect(sliderRange('release_time', 19.9, kScales).most).toBe(20);
});

const kFit = {
  model: 'viscous',
  parameters: { inertia: { estimate: 0.04 } },
  derived: { small_angle_period: { estimate: 1.25 }, natural_frequency: { estimate: 5 } },
} as unknown as Fit;

const samplesOf = (fitted: number[], angle: number[] | null): Samples => ({
  time: Float64Array.of(0, 1),
  measured: Float64Array.of(0, 1),
  unit: 'px',
  models: new Map([['viscous', { fitted: Float64Array.from(fitted) }]]) as unknown as Samples['models'],
  motions: new Map(angle ? [['viscous', { angle: Float64Array.from(angle) } as Motion]] : []),
});

test('the scales are those of the result, and the amplitude that of the angle where the readings do not show it', () => {
  const { period, amplitude, reading, torque, window } = scalesOf(kFit, samplesOf([760, 1160], [-0.3, 0.3]))!;
  expect([period, amplitude, reading, window]).toEqual([1.25, 0.3, 200, [0, 1]]);
  expect(torque).toBeCloseTo(0.04 * 5 ** 2, 12);
  expect(scalesOf(kFit, samplesOf([-0.25, 0.25], null))!.amplitude).toBe(0.25);
});

test('a fit without estimates has no scales', () => {
  const failed = { ...kFit, parameters: { inertia: { estimate: null } } } as unknown as Fit;
  expect(scalesOf(failed, samplesOf([0, 1], null))).toBeNull();
});
