// SPDX-License-Identifier: Apache-2.0
import { expect, test } from 'vitest';

import { timeWords } from './views/batch_view';
import { durationWords } from './waiting';

test('durations are in seconds, from a minute on also in minutes', () => {
  expect(durationWords(7.6)).toBe('8 s');
  expect(durationWords(59.7)).toBe('1 min 0 s');
  expect(durationWords(125)).toBe('2 min 5 s');
});

test('a batch that takes longer than two seconds says how long', () => {
  expect(timeWords(1.9, 3, 5)).toBe('');
  expect(timeWords(10, 0, 5)).toBe('10 s so far.');
  expect(timeWords(10, 4, 6)).toBe('10 s so far, about 15 s left.');
  expect(timeWords(10, 4, 0)).toBe('');
});
