// SPDX-License-Identifier: Apache-2.0
import { expect, test } from 'vitest';

import type { Result } from '../shared/result_types';
import { otherWarnings, warningsOf } from './report';

const result = {
  fits: [{ model: 'viscous' }, { model: 'coulomb' }, { model: 'drag' }],
  warnings: [
    { code: 'gaps', message: 'readings are missing' },
    { code: 'lack_of_fit', message: 'viscous: the residuals are more than noise' },
    { code: 'at_bound', message: 'drag: at the bound 0: drag' },
  ],
} as unknown as Result;

test('a law has its own warnings and those of the recording', () => {
  expect(warningsOf(result, 'drag').map(({ message }) => message)).toEqual(['readings are missing', 'at the bound 0: drag']);
  expect(warningsOf(result, 'coulomb').map(({ code }) => code)).toEqual(['gaps']);
});

test('warnings of the other laws are with these laws', () => {
  const others = otherWarnings(result, 'drag');
  expect(others.map(({ model }) => model)).toEqual(['viscous']);
  expect(others[0].warnings[0].message).toBe('the residuals are more than noise');
});
