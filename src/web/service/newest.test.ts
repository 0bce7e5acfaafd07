// SPDX-License-Identifier: Apache-2.0
import { expect, test, vi } from 'vitest';

import { Newest } from './newest';

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
  const newest = new Newest(work);
  for (const value of [1, 2, 3, 4]) void newest.ask(value);
  await settled();
  expect(begun).toEqual([1]);
  end();
  await settled();
  expect(begun).toEqual([1, 4]);
  end();
  await settled();
  expect(begun).toEqual([1, 4]);
  void newest.ask(5);
  await settled();
  expect(begun).toEqual([1, 4, 5]);
});

test('after work that throws, the newest value has its turn', async () => {
  const done: number[] = [];
  const newest = new Newest(async (value: number) => {
    await settled();
    if (value < 0) throw new Error('no');
    done.push(value);
  });
  const first = newest.ask(-1);
  void newest.ask(2);
  await expect(first).rejects.toThrow('no');
  await vi.waitFor(() => expect(done).toEqual([2]));
  await newest.ask(3);
  expect(done).toEqual([2, 3]);
});

test('work that throws before it waits for anything does not block the next', async () => {
  const newest = new Newest((value: number) => {
    if (value < 0) throw new Error('no');
    return Promise.resolve();
  });
  await expect(newest.ask(-1)).rejects.toThrow('no');
  await newest.ask(2);
});

test('dropped values are neither worked on nor waited for', async () => {
  const { begun, end, work } = held();
  const signals: AbortSignal[] = [];
  const newest = new Newest((value: number, dropped) => {
    signals.push(dropped);
    return work(value);
  });
  void newest.ask(1);
  void newest.ask(2);
  newest.drop();
  expect(signals[0].aborted).toBe(true);
  end();
  await settled();
  expect(begun).toEqual([1]);
  void newest.ask(3);
  expect(begun).toEqual([1, 3]);
  expect(signals[1].aborted).toBe(false);
});
