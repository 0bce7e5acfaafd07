// SPDX-License-Identifier: Apache-2.0
import { expect, test } from 'vitest';

import type { Result } from '../shared/result_types';
import { bestFit, otherWarnings, warningsOf } from './report';

const result = {
  fits: [{ model: 'viscous' }, { model: 'coulomb' }, { model: 'drag' }],
  warnings: [
    { code: 'gaps', message: 'readings are missing' },
    { code: 'lack_of_fit', message: 'viscous: the residuals', text: 'the residuals', law: 'viscous' },
    { code: 'at_bound', message: 'drag: at the bound 0: drag', text: 'at the bound 0: drag', law: 'drag' },
  ],
} as unknown as Result;

test('a law has its own warnings and those of the recording', () => {
  expect(warningsOf(result, 'drag').map(({ message }) => message)).toEqual(['readings are missing', 'at the bound 0: drag']);
  expect(warningsOf(result, 'coulomb').map(({ code }) => code)).toEqual(['gaps']);
});

test('warnings of the other laws are with these laws', () => {
  const others = otherWarnings(result, 'drag');
  expect(others.map(({ model }) => model)).toEqual(['viscous']);
  expect(others[0].warnings[0].message).toBe('the residuals');
});

test('the best fit is the recommended one, else the one with the smallest residuals that converged', () => {
  const fits = [
    { model: 'viscous', status: 'converged', statistics: { rms_residual_rad: 0.02 } },
    { model: 'coulomb', status: 'converged', statistics: { rms_residual_rad: 0.01 } },
    { model: 'stribeck', status: 'not_identifiable', statistics: { rms_residual_rad: 0.005 } },
  ];
  const of = (some: object[], recommended?: string) =>
    bestFit({ fits: some, comparison: recommended ? { recommended } : null } as unknown as Result);
  expect(of(fits, 'viscous')).toBe(0);
  expect(of(fits)).toBe(1);
  expect(of(fits.slice(2))).toBe(0);
  expect(of([])).toBe(-1);
});
