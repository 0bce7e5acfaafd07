// SPDX-License-Identifier: Apache-2.0
import { expect, test } from 'vitest';

import { centralDifferences, thinned } from './phase';

test('central differences of a parabola are exact between the ends, and NaN across a gap', () => {
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
