// SPDX-License-Identifier: Apache-2.0
import { expect, test } from 'vitest';

import { histogram, normalDensity } from './histogram';

test('a histogram counts every value once, and its density integrates to 1', () => {
  const values = Float64Array.from({ length: 5000 }, (_unused, i) => Math.sin(i));
  const bars = histogram(values)!;
  expect(bars.counts.reduce((sum, n) => sum + n, 0)).toBe(5000);
  expect(bars.density.reduce((sum, d) => sum + d, 0) * bars.width).toBeCloseTo(1, 12);
  expect(bars.start).toBeLessThanOrEqual(-1);
});

test('a constant has no histogram', () => {
  expect(histogram(new Float64Array(5))).toBeNull();
});

test('the normal density at 0 and at one deviation', () => {
  expect(normalDensity(0, 0, 1)).toBeCloseTo(0.3989422804, 9); // 1 / sqrt(2 π)
  expect(normalDensity(4, 2, 2)).toBeCloseTo(0.2419707245 / 2, 9); // exp(-1/2) / sqrt(2 π)
});
