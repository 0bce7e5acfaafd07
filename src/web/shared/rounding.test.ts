// SPDX-License-Identifier: Apache-2.0
import { describe, expect, test } from 'vitest';

import {
  errorText,
  fixed,
  plusMinus,
  probabilityText,
  significant,
  timeText,
  windowText,
} from './rounding';

describe('value ± error', () => {
  // Particle Data Group, Review of Particle Physics, introduction, "Rounding": the first three of its examples.
  test.each([
    [0.827, 0.119, '0.83 ± 0.12'],
    [0.827, 0.367, '0.8 ± 0.4'],
    [14.674, 0.964, '14.7 ± 1.0'],
    [0.827, 0.354, '0.83 ± 0.35'],
    [0.827, 0.355, '0.8 ± 0.4'],
    [0.827, 0.949, '0.8 ± 0.9'],
    [0.827, 0.95, '0.8 ± 1.0'],
  ])('%f ± %f is rounded as the Particle Data Group does', (value, error, expected) => {
    expect(plusMinus(value, error)).toBe(expected);
  });

  test('halves of decimal digits are rounded up, regardless of the nearest double', () => {
    expect(plusMinus(0.1, 0.0075)).toBe('0.100 ± 0.008');
  });

  test('small numbers share a power of ten', () => {
    expect(plusMinus(1.234e-5, 3.1e-7)).toBe('(1.234 ± 0.031) × 10⁻⁵');
    expect(plusMinus(-1.234e-5, 3.1e-7)).toBe('(−1.234 ± 0.031) × 10⁻⁵');
    expect(plusMinus(0, 2e-6)).toBe('(0.0 ± 2.0) × 10⁻⁶');
  });

  test('a mantissa stays below ten when value or error is rounded up', () => {
    expect(plusMinus(9.97e-6, 5e-7)).toBe('(1.00 ± 0.05) × 10⁻⁵');
    expect(plusMinus(3e-6, 9.6e-6)).toBe('(0.3 ± 1.0) × 10⁻⁵');
    expect(plusMinus(9.4e-6, 9.6e-6)).toBe('(0.9 ± 1.0) × 10⁻⁵');
    expect(plusMinus(-9.6e-6, 2e-6)).toBe('(−9.6 ± 2.0) × 10⁻⁶');
    expect(plusMinus(6e-8, 5e-7)).toBe('(1 ± 5) × 10⁻⁷');
    expect(plusMinus(4e-8, 5e-7)).toBe('(0 ± 5) × 10⁻⁷');
    expect(errorText(9.6e-6, null, null)).toBe('1.0 × 10⁻⁵');
    expect(errorText(1e-5, 4e-6, 1e-7)).toBe('1.0 × 10⁻⁵');
    expect(significant(9.9999e-6, 3)).toBe('1 × 10⁻⁵');
  });

  test('large numbers do, too, if the error has no decimals', () => {
    expect(plusMinus(12345678, 120000)).toBe('(1.235 ± 0.012) × 10⁷');
  });

  test('values are rounded to tens and hundreds', () => {
    expect(plusMinus(0, 74.5)).toBe('0 ± 70');
    expect(plusMinus(123456, 1200)).toBe('123500 ± 1200');
  });

  test('null is a dash, and without an error only the value is written', () => {
    expect(plusMinus(null, 0.1)).toBe('–');
    expect(plusMinus(0.25, null)).toBe('0.25');
    expect(plusMinus(0, 0)).toBe('0');
    expect(plusMinus(NaN, 1)).toBe('–');
  });

  test('a second error has the decimals that it needs', () => {
    expect(errorText(4.1e-5, 0.079, 2.8e-6)).toBe('0.00004');
    expect(errorText(1.2e-5, 0.079, 2.8e-6)).toBe('0.000012');
    expect(errorText(1.2e-5, 4.44e-5, 2e-7)).toBe('1.2 × 10⁻⁵');
    expect(errorText(3.4e-8, 0.00111, 4.1e-6)).toBe('3.4 × 10⁻⁸');
    expect(errorText(null, 1, 1)).toBe('–');
  });
});

test('significant digits have no trailing zeros', () => {
  expect(significant(19.99, 4)).toBe('19.99');
  expect(significant(100.00000000000001, 4)).toBe('100');
  expect(significant(9.9996, 4)).toBe('10');
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

test('probabilities', () => {
  expect(probabilityText(0.4321)).toBe('0.43');
  expect(probabilityText(2.2e-9)).toBe('2 × 10⁻⁹');
  expect(probabilityText(1e-161)).toBe('< 10⁻⁹⁹');
  expect(probabilityText(0)).toBe('< 10⁻⁹⁹');
  expect(probabilityText(null)).toBe('–');
});
