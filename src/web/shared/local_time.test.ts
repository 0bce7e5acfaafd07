// SPDX-License-Identifier: Apache-2.0
import { expect, test } from 'vitest';

import { localTimeText } from './local_time';

// browser/summary_test.mjs has the time zones.
test('a time has its date in ISO order', () => {
  expect(localTimeText(new Date(2026, 11, 1, 7, 3, 59).toISOString())).toBe('2026-12-01 07:03');
});

test('a text that is no time stays', () => expect(localTimeText('yesterday')).toBe('yesterday'));
