// SPDX-License-Identifier: Apache-2.0
import { expect, test } from 'vitest';

import { kMeasured, modelMark } from '../shared/marks';
import type { Result, Series } from '../shared/result_types';
import { makeReport } from './report';
import { swingsOf, valueAt } from './swing_animation';

test('between samples the pendulum is on the straight line, and outside them nowhere', () => {
  const time = Float64Array.of(1, 2, 4);
  const values = Float64Array.of(0, 1, NaN);
  expect(valueAt(time, values, 1)).toBe(0);
  expect(valueAt(time, values, 1.25)).toBe(0.25);
  expect(valueAt(time, values, 2)).toBe(1);
  for (const t of [0.9, 3, 4.1]) expect(valueAt(time, values, t)).toBeNaN();
});

/** A report of two samples 0.5 s apart from 10 s on, whose zero is 0.1 and drifts by 0.2 per s. */
function swings(unit: string, motion: boolean): ReturnType<typeof swingsOf> {
  const parameters = { zero_angle: { estimate: 0.1 }, zero_drift: { estimate: 0.2 } };
  const fit = { model: 'coulomb', status: 'converged', parameters, identifiability: [] };
  const result = { fits: [fit], recordings: [{ window_s: [10, 10.5], fits: [{ parameters: {}, identifiability: [] }] }], comparison: null };
  const curve = { start_s: 10, interval_s: 0.5, angle: [0.3, 0.4], rate: [1, 1], reading: [0, 0] };
  const series = {
    time_s: [10, 10.5],
    measured: [1.1, 1.2],
    unit,
    models: { coulomb: { fitted: [1.2, 1.3] } },
    motions: motion ? { coulomb: curve } : {},
  };
  const report = makeReport(result as unknown as Result, [series] as unknown as Series[], null);
  const [one] = report.recordings;
  return swingsOf(one, one.samples!, kMeasured, modelMark(0));
}

test('angles count from the zero that the fit found', () => {
  const [measured, fitted] = swings('rad', false).map(({ angle }) => [...angle]);
  expect(measured[0]).toBeCloseTo(1.0, 12); // 1.1 - 0.1
  expect(measured[1]).toBeCloseTo(1.0, 12); // 1.2 - 0.1 - 0.2 * 0.5
  expect(fitted[1]).toBeCloseTo(1.1, 12);
});

test('a rate has no measured angle', () => {
  expect(swings('rad/s', false)).toEqual([]);
  expect(swings('rad/s', true).map(({ name, angle }) => [name, ...angle])).toEqual([['coulomb', 0.3, 0.4]]);
});
