// SPDX-License-Identifier: Apache-2.0
import { expect, test } from 'vitest';

import { forNewest } from './newest';

/** Work that ends when it is told to. */
function held() {
  const begun: number[] = [];
  const ends: (() => void)[] = [];
  const work = (value: number): Promise<void> => {
    begun.push(value);
    return new Promise((resolve) => ends.push(resolve));
  };
  return { begun, end: () => ends.shift()!(), work };
}

const settled = (): Promise<void> => new Promise((resolve) => setTimeout(resolve));

test('one value at a time is worked on, then the newest of those that came meanwhile', async () => {
  const { begun, end, work } = held();
  const newest = forNewest(work);
  for (const value of [1, 2, 3, 4]) void newest(value);
  await settled();
  expect(begun).toEqual([1]);
  end();
  await settled();
  expect(begun).toEqual([1, 4]);
  end();
  await settled();
  expect(begun).toEqual([1, 4]);
  void newest(5);
  await settled();
  expect(begun).toEqual([1, 4, 5]);
});
