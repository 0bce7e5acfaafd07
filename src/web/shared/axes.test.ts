// SPDX-License-Identifier: Apache-2.0
import { describe, expect, test } from 'vitest';

import { logTicks, roundTicks, tickTexts } from './axes';

describe('ticks', () => {
  test('have enough decimals, all the same number', () => {
    expect(tickTexts([0, 0.05, 0.1], 0.05)).toEqual(['0.00', '0.05', '0.10']);
    expect(tickTexts([-1, 0, 1], 1)).toEqual(['−1', '0', '1']);
    expect(tickTexts([0, 2e-6], 2e-6)).toEqual(['0', '2×10⁻⁶']);
  });

  test('of a logarithmic axis are 1, 2 and 5 times powers of ten', () => {
    expect(logTicks(0.03, 0.6).map((tick) => Number(tick.toPrecision(3)))).toEqual([0.05, 0.1, 0.2, 0.5]);
    expect(logTicks(0, 1)).toEqual([]);
    expect(roundTicks(-24, 24).map((tick) => tick + 0)).toEqual([-20, -10, 0, 10, 20]);
  });
});
