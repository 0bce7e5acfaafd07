// SPDX-License-Identifier: Apache-2.0
import { expect, test } from 'vitest';

import { fileName } from './names';

test('file names have no folders', () => {
  expect(fileName('a/b/run.csv')).toBe('run.csv');
  expect(fileName('C:\\a\\run.csv')).toBe('run.csv');
  expect(fileName(null)).toBe('recording without a name');
});
