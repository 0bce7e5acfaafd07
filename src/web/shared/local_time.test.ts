// SPDX-License-Identifier: Apache-2.0
import { expect, test } from 'vitest';

import { localTimeText } from './local_time';

// browser/summary_test.mjs has the time zones.
test('a time has its date in ISO order', () => {
  const instant = new Date(2026, 11, 1, 7, 3, 59).toISOString();
  expect(localTimeText(instant)).toBe('2026-12-01 07:03');
  expect(localTimeText(instant, true)).toBe('2026-12-01 07:03:59');
});

test('a text that is no time stays', () => expect(localTimeText('yesterday')).toBe('yesterday'));
