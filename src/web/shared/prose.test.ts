// SPDX-License-Identifier: Apache-2.0
import { expect, test } from 'vitest';

import { inList, sentence, typeset, withTheta } from './prose';

test('sentences are typeset', () => {
  expect(typeset('(3.00 ± 0.12)e-06')).toBe('(3.00 ± 0.12) × 10⁻⁶');
  expect(typeset('p 4.1e-26, 0.00126 kg m^2, 1e+06 and e2e')).toBe('p 4.1 × 10⁻²⁶, 0.00126 kg m², 1 × 10⁶ and e2e');
  expect(sentence('the fit failed')).toBe('The fit failed.');
  expect(sentence('')).toBe('');
});

test('a hyphen before a number is a minus sign, and no other', () => {
  expect(typeset('-0.02 to -1e-05, [-3, -2], lag-1, 1-2, --to -x')).toBe('−0.02 to −1 × 10⁻⁵, [−3, −2], lag-1, 1-2, --to -x');
  expect(withTheta("0.1 th'' - 2 sin th")).toBe('0.1 θ″ − 2 sin θ');
});

test('lists in words', () => {
  expect(inList([1, 2, 3])).toBe('1, 2 and 3');
  expect(inList([])).toBe('');
});
