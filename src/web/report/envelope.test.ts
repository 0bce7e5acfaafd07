// SPDX-License-Identifier: Apache-2.0
import { describe, expect, test } from 'vitest';

import type { Recording, Series } from '../shared/result_types';
import { curveTurns, decrementRate, exponentialThrough, measuredTurns, zeroOf } from './envelope';

describe('amplitudes', () => {
  const time = Float64Array.from({ length: 2001 }, (_unused, i) => i * 0.01);
  const wave = time.map((t) => 0.05 + 0.4 * Math.exp(-0.1 * t) * Math.cos(5 * t));

  test('the turning points of a curve are on its envelope', () => {
    const turns = curveTurns(time, wave, () => 0.05);
    expect(turns).toHaveLength(31); // at (n π - atan 0.02) / 5 up to 20 s
    for (const turn of turns)
      expect(turn.amplitude).toBeCloseTo(0.4 * Math.exp(-0.1 * turn.time) * Math.cos(Math.atan(0.02)), 4);
  });

  test('the exponential goes through exponential points', () => {
    const turns = [1, 2, 3].map((t) => ({ time: t, amplitude: 2 * Math.exp(-0.3 * t), error: null }));
    exponentialThrough(turns, 0.3, [0, 5]).forEach((a, i) => expect(a).toBeCloseTo(2 * Math.exp(-0.3 * [0, 5][i]), 12));
  });

  test('the decay rate is the log decrement over the period', () => {
    const linear = { log_decrement: { estimate: 0.05 }, damped_frequency: { estimate: Math.PI } };
    const recording = { closed_forms: { linear }, clock_scale: 1 } as unknown as Recording;
    expect(decrementRate(recording)).toBeCloseTo(0.025, 12);
    expect(decrementRate({ ...recording, closed_forms: null })).toBeNull();
  });

  test('peaks are preferred to extrema, and the zero may drift', () => {
    const zero = zeroOf({ zero_angle: { estimate: 0.1 }, zero_drift: { estimate: 0.01 } }, 2);
    expect(zero(12)).toBeCloseTo(0.2, 12);
    const peaks = [{ number: 1, time_s: 12, angle_rad: -0.3, std_error: 0.001 }];
    const series = { peaks, extrema: [[1, 1]] } as unknown as Series;
    expect(measuredTurns(series, zero)).toEqual([{ time: 12, amplitude: 0.5, error: 0.001 }]);
    expect(measuredTurns({ ...series, peaks: [] }, () => 0)).toEqual([{ time: 1, amplitude: 1, error: null }]);
  });
});
