// SPDX-License-Identifier: Apache-2.0
import { describe, expect, test } from 'vitest';

import { apparentFrequency, apparentSwing } from './aliasing';

describe('slow sampling', () => {
  test('the apparent frequency is the distance to the nearest multiple of the rate', () => {
    expect(apparentFrequency(0.76, 1)).toEqual({ apparent: expect.closeTo(0.24, 12), cycles: 1 });
    expect(apparentFrequency(2.1, 1).apparent).toBeCloseTo(0.1, 12);
    expect(apparentFrequency(0.3, 1)).toEqual({ apparent: 0.3, cycles: 0 });
  });

  test('the apparent swing goes through the samples of the true one', () => {
    const [frequency, rate] = [0.76, 1];
    const turns = Array.from({ length: 40 }, (_unused, n) => ({
      time: n / (2 * frequency),
      amplitude: 1,
      error: null,
    }));
    const samples = Float64Array.from({ length: 20 }, (_unused, i) => i / rate);
    const values = apparentSwing(turns, 1, samples, 1, rate, 0);
    samples.forEach((t, i) => expect(values[i]).toBeCloseTo(Math.cos(2 * Math.PI * frequency * t), 9));
    const between = apparentSwing(turns, 1, Float64Array.of(1.7), 1, rate, 0);
    expect(between[0]).toBeCloseTo(Math.cos(2 * Math.PI * 0.24 * 1.7), 9);
  });
});
