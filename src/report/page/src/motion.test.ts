// SPDX-License-Identifier: Apache-2.0
import { describe, expect, test } from 'vitest';

import { apparentFrequency, apparentSwing } from './aliasing';
import { curveTurns, decrementRate, exponentialThrough, measuredTurns, zeroOf } from './envelope';
import { centralDifferences, thinned } from './phase';
import { integrate, motionOf, type Motion } from './trajectory';
import type { Fit, Parameter, Result, Series } from './types';

const kFree: Motion = { linear: true, gravity: 25, viscous: 0, coulomb: 0, drag: 0, stiction: 0, stribeckRate: 1, constant: 0 };
const last = (values: Float64Array): number => values[values.length - 1];

describe('the equation of motion', () => {
  test('the linear pendulum with viscous friction follows its closed form', () => {
    const motion = integrate({ ...kFree, viscous: 0.2 }, 0.3, 0, 10, 0.01);
    const frequency = Math.sqrt(25 - 0.01);
    const expected = (t: number): number =>
      0.3 * Math.exp(-0.1 * t) * (Math.cos(frequency * t) + (0.1 / frequency) * Math.sin(frequency * t));
    motion.time.forEach((t, i) => expect(motion.angle[i]).toBeCloseTo(expected(t), 6));
  });

  test('a large swing has the period of the elliptic integral', () => {
    // (2/π) K(sin 45°) = 1.180340599016 at 90 degrees; a quarter of it later the angle is 0.
    const quarter = (0.25 * 2 * Math.PI * 1.180340599016) / 5;
    expect(last(integrate({ ...kFree, linear: false }, Math.PI / 2, 0, quarter, 0.002).angle)).toBeCloseTo(0, 7);
  });

  test('dry friction takes 2 τ_c / G from each half swing, and holds the pendulum in the end', () => {
    const motion = integrate({ ...kFree, coulomb: 25 * 0.01, stiction: 25 * 0.01 }, 0.105, 0, 8, 0.005);
    // 0.105, 0.085, 0.065, 0.045, 0.025, 0.005: then friction holds it, 5 half swings of π/5 s later.
    const atTurn = (n: number): number =>
      motion.angle[Math.round((n * Math.PI) / 5 / (motion.time[1] - motion.time[0]))];
    [0.105, -0.085, 0.065, -0.045, 0.025, -0.005].forEach((angle, n) => expect(atTurn(n)).toBeCloseTo(angle, 4));
    expect(last(motion.angle)).toBeCloseTo(-0.005, 6);
    expect(last(motion.rate)).toBe(0);
  });

  test('energy never rises with all terms', () => {
    const motion = integrate(
      { linear: false, gravity: 20, viscous: 0.05, coulomb: 0.1, drag: 0.02, stiction: 0.2, stribeckRate: 0.1, constant: 0 },
      1,
      0,
      20,
      0.01,
    );
    const energy = motion.angle.map((angle, i) => 0.5 * motion.rate[i] ** 2 + 20 * (1 - Math.cos(angle)));
    for (let i = 1; i < energy.length; ++i) expect(energy[i]).toBeLessThanOrEqual(energy[i - 1] + 1e-9);
  });

  test('a law that is not known is not guessed', () => {
    const parameter = (estimate: number): Parameter => ({ estimate, unit: 's^2' }) as Parameter;
    const fit = {
      model: 'viscous',
      parameters: { inertia: parameter(0.04), viscous: parameter(0.002) },
      derived: {},
    } as unknown as Fit;
    expect(motionOf(fit)).toMatchObject({ gravity: 25, viscous: 0.05, coulomb: 0 });
    expect(motionOf({ ...fit, model: 'mystery' })).toBeNull();
  });
});

describe('amplitudes', () => {
  const time = Float64Array.from({ length: 2001 }, (_unused, i) => i * 0.01);
  const wave = time.map((t) => 0.05 + 0.4 * Math.exp(-0.1 * t) * Math.cos(5 * t));

  test('turning points of a curve lie on its envelope', () => {
    const turns = curveTurns(time, wave, () => 0.05);
    expect(turns).toHaveLength(31); // at (n π - atan 0.02) / 5 up to 20 s
    for (const turn of turns)
      expect(turn.amplitude).toBeCloseTo(0.4 * Math.exp(-0.1 * turn.time) * Math.cos(Math.atan(0.02)), 4);
  });

  test('the exponential goes through points that are exponential', () => {
    const turns = [1, 2, 3].map((t) => ({ time: t, amplitude: 2 * Math.exp(-0.3 * t), error: null }));
    exponentialThrough(turns, 0.3, [0, 5]).forEach((a, i) => expect(a).toBeCloseTo(2 * Math.exp(-0.3 * [0, 5][i]), 12));
  });

  test('the rate of the log decrement is δ over the period', () => {
    const linear = { log_decrement: { estimate: 0.05 }, damped_frequency: { estimate: Math.PI } };
    const result = { closed_forms: { linear }, data: { clock_scale: 1 } } as unknown as Result;
    expect(decrementRate(result)).toBeCloseTo(0.025, 12);
    expect(decrementRate({ ...result, closed_forms: null })).toBeNull();
  });

  test('peaks come before extrema, and the zero drifts', () => {
    const zero = zeroOf({ zero_angle: { estimate: 0.1 }, zero_drift: { estimate: 0.01 } }, 2);
    expect(zero(12)).toBeCloseTo(0.2, 12);
    const peaks = [{ number: 1, time_s: 12, angle_rad: -0.3, std_error: 0.001 }];
    const series = { peaks, extrema: [[1, 1]] } as unknown as Series;
    expect(measuredTurns(series, zero)).toEqual([{ time: 12, amplitude: 0.5, error: 0.001 }]);
    expect(measuredTurns({ ...series, peaks: [] }, () => 0)).toEqual([{ time: 1, amplitude: 1, error: null }]);
  });
});

describe('sampled too slowly', () => {
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

test('central differences of a parabola are exact within, and NaN across a gap', () => {
  const time = Float64Array.of(0, 1, 2, 3);
  expect([
    ...centralDifferences(
      time,
      time.map((t) => t * t),
    ),
  ]).toEqual([1, 2, 4, 5]);
  expect(centralDifferences(Float64Array.of(0, 1, 9), Float64Array.of(0, 1, 2), 2)[1]).toBeNaN();
  expect([...thinned(Float64Array.of(0, 1, 2, 3, 4), 3)]).toEqual([0, 2, 4]);
});
