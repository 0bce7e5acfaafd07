// SPDX-License-Identifier: Apache-2.0
import { expect, test } from 'vitest';

import { autocorrelation, moments } from './autocorrelation';

test('autocorrelation of 1 2 3 4, by hand', () => {
  // About the mean: -1.5 -0.5 0.5 1.5, squares 5; lag 1: 0.75 - 0.25 + 0.75 = 1.25; lag 2: -0.75 - 0.75; lag 3: -2.25.
  const { r, used } = autocorrelation(Float64Array.of(1, 2, 3, 4), 10);
  expect(used).toBe(4);
  expect(r).toHaveLength(4);
  [1, 0.25, -0.3, -0.45].forEach((expected, k) => expect(r[k]).toBeCloseTo(expected, 12));
});

test('the autocorrelation of a swing oscillates with its period', () => {
  const wave = Float64Array.from({ length: 10_000 }, (_unused, i) => Math.cos((2 * Math.PI * i) / 20));
  const { r } = autocorrelation(wave, 20);
  expect(r[10]).toBeCloseTo(-1, 2);
  expect(r[20]).toBeCloseTo(1, 2);
});

test('a constant has no autocorrelation, and NaN is not used', () => {
  expect(autocorrelation(new Float64Array(10).fill(2), 5).r).toEqual([]);
  expect(autocorrelation(Float64Array.of(1, NaN, 2, 3, 4), 2).used).toBe(4);
});

test('only the first 200000 of a million values are used', () => {
  const values = Float64Array.from({ length: 1_000_000 }, (_unused, i) => i % 2);
  const { r, used } = autocorrelation(values, 100);
  expect(used).toBe(200_000);
  expect(r[1]).toBeCloseTo(-1, 4);
});

test('moments of 2 4 4 4 5 5 7 9: mean 5, 32 / 7 squared', () => {
  const { mean, deviation, count } = moments([2, 4, 4, 4, 5, 5, 7, 9]);
  expect([mean, count]).toEqual([5, 8]);
  expect(deviation).toBeCloseTo(Math.sqrt(32 / 7), 12);
});
