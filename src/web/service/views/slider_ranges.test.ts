// SPDX-License-Identifier: Apache-2.0
import { expect, test } from 'vitest';

import { sliderRange } from './slider_ranges';

const kScales = { period: 1.3, amplitude: 0.5, torque: 1.8 };
const kNames = ['inertia', 'viscous', 'coulomb', 'drag', 'stiction', 'stribeck_rate', 'asymmetry', 'release_time'];
const kOthers = ['release_angle', 'initial_angle', 'initial_rate', 'zero_angle', 'rate_bias', 'zero_drift', 'radius'];

test('every range contains its estimate and is not empty, also for an estimate of 0', () => {
  for (const name of [...kNames, ...kOthers]) {
    for (const estimate of name === 'inertia' || name === 'stribeck_rate' ? [0.08] : [0, 0.08]) {
      const { least, most } = sliderRange(name, estimate, kScales);
      expect(most, name).toBeGreaterThan(least);
      expect(least, name).toBeLessThanOrEqual(estimate);
      expect(most, name).toBeGreaterThanOrEqual(estimate);
    }
  }
});

test('inertia stays positive and friction never drives the motion', () => {
  expect(sliderRange('inertia', 0.08, kScales).least).toBeGreaterThan(0);
  for (const name of ['viscous', 'coulomb', 'drag', 'stiction']) expect(sliderRange(name, 0.01, kScales).least).toBe(0);
});
