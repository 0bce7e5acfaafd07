// SPDX-License-Identifier: Apache-2.0
import { expect, test } from 'vitest';

import { fixed, significant, timeText, windowText } from './rounding';

test('significant digits have no trailing zeros', () => {
  expect(significant(19.99, 4)).toBe('19.99');
  expect(significant(100.00000000000001, 4)).toBe('100');
  expect(significant(9.9996, 4)).toBe('10');
  expect(significant(9.9999e-6, 3)).toBe('1 × 10⁻⁵');
  expect(significant(12345678, 3)).toBe('1.23 × 10⁷');
  expect(significant(0.00012, 3)).toBe('0.00012');
  expect(significant(1.5e-5, 3)).toBe('1.5 × 10⁻⁵');
  expect(significant(2000, 5)).toBe('2000');
  expect(significant(0, 3)).toBe('0');
  expect(significant(-0.5, 2)).toBe('−0.5');
  expect(significant(undefined)).toBe('–');
});

test('the times of a window have the decimals that its duration needs', () => {
  expect(windowText([50490.1, 50510.1])).toBe('50490.1 to 50510.1\u00a0s');
  expect(windowText([0, 19.9954])).toBe('0 to 20\u00a0s');
  expect(windowText([1.25, 13.375])).toBe('1.25 to 13.38\u00a0s');
  expect(windowText([0, 86400.25])).toBe('0 to 86400\u00a0s');
  expect(windowText([10000, 10000.0025])).toBe('10000 to 10000.0025\u00a0s');
  expect(windowText([-3, 400])).toBe('−3 to 400\u00a0s');
  expect(windowText([2, 2])).toBe('2 to 2\u00a0s');
  expect(timeText(50490.125, 20)).toBe('50490.13');
});

test('zero has no minus sign', () => {
  expect(fixed(-0.0001, 2)).toBe('0.00');
  expect(fixed(-0.01, 2)).toBe('−0.01');
});
