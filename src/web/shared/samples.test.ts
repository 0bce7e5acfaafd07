// SPDX-License-Identifier: Apache-2.0
import { describe, expect, test } from 'vitest';

import type { Series } from './result_types';
import { rootMeanSquare, toArray, toSamples } from './samples';

describe('null in the JSON', () => {
  test('null becomes NaN, and an array of another length is null', () => {
    expect([...toArray([1, null, 3], 3)!]).toEqual([1, NaN, 3]);
    expect(toArray([1], 2)).toBeNull();
    expect(toArray(null, 2)).toBeNull();
    expect(rootMeanSquare(Float64Array.of(3, NaN, 4))).toBeCloseTo(Math.sqrt(12.5), 12);
  });

  test('there may be no series, or no fitted values', () => {
    expect(toSamples(null)).toBeNull();
    const series = {
      time_s: [0, 1],
      measured: [null, 1],
      unit: 'rad',
      models: { a: { fitted: null } },
    } as unknown as Series;
    expect(toSamples(series)?.models.get('a')?.fitted).toBeNull();
    expect(toSamples(series)?.motions.size).toBe(0);
  });
});

test('the points of a motion are at equal steps from its start', () => {
  const motion = { start_s: 10, interval_s: 0.5, angle_unit: 'rad', angle: [1, 0, -1], rate: [0, -2, 0], reading: [1.5, 0.5, null] };
  const series = { time_s: [0, 1], measured: [0, 1], unit: 'rad', models: {}, motions: { drag: motion, stribeck: null } };
  const { motions } = toSamples(series as unknown as Series)!;
  expect([...motions.keys()]).toEqual(['drag']);
  const { time, angle, rate, reading } = motions.get('drag')!;
  expect([time, angle, rate, reading].map((values) => [...values])).toEqual([[10, 10.5, 11], [1, 0, -1], [0, -2, 0], [1.5, 0.5, NaN]]);
});
