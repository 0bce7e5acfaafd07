// SPDX-License-Identifier: Apache-2.0
import { expect, test } from 'vitest';

import { budgetSentence, sharesOf, sourcesOf } from './budget';
import type { Fit } from '../shared/result_types';

test('shares are those of the variance', () => {
  // 3² + 4² = 5²: 36 % and 64 %.
  const shares = sharesOf({ error_budget: { clock: 4e-9, noise: 3e-9, rig: 0 } });
  expect(shares.map(({ source }) => source.key)).toEqual(['noise', 'clock']);
  expect(shares[0].share).toBeCloseTo(0.36, 12);
  expect(shares[1].share).toBeCloseTo(0.64, 12);
});

test('errors whose squares are below the least double have shares', () => {
  const shares = sharesOf({ error_budget: { noise: 1e-200, calibration: 1e-200 } });
  expect(shares.map(({ share }) => share)).toEqual([0.5, 0.5]);
});

test('the sentence has the largest source first', () => {
  expect(budgetSentence(sharesOf({ error_budget: { noise: 3, calibration: 4 } }))).toBe(
    'Variance: 64 % calibration and 36 % noise.',
  );
  expect(budgetSentence(sharesOf({ error_budget: { noise: 0.01, rig: 1, clock: 1 } }))).toBe(
    'Variance: 50 % rig, 50 % clock and less than 1 % noise.',
  );
});

test('a parameter without an error has no shares', () => {
  expect(sharesOf({ error_budget: null })).toEqual([]);
  expect(sharesOf({ error_budget: { noise: null } })).toEqual([]);
});

test('the sources of a fit are those of its parameters', () => {
  const parameters = { a: { error_budget: { noise: 1 } }, b: { error_budget: { rig: 1 } } };
  expect(sourcesOf({ parameters } as unknown as Fit).map(({ key }) => key)).toEqual(['noise', 'rig']);
});
