// SPDX-License-Identifier: Apache-2.0
import { expect, test } from 'vitest';

import { decimate, decimateArea } from './decimate';
import { extent } from './samples';

const times = (size: number, step = 0.001): Float64Array =>
  Float64Array.from({ length: size }, (_unused, i) => i * step);

test('few samples are drawn unchanged', () => {
  const time = times(5, 1);
  const values = Float64Array.of(3, 1, 4, 1, 5);
  const shown = decimate(time, values, 0, 4, 100);
  expect(shown.dense).toBe(false);
  expect([...shown.x]).toEqual([0, 1, 2, 3, 4]);
  expect([...shown.y]).toEqual([3, 1, 4, 1, 5]);
});

test('one sample beyond each end is kept, so that lines reach the edge', () => {
  const shown = decimate(times(11, 1), times(11, 1), 3.5, 6.5, 100);
  expect([...shown.x]).toEqual([3, 4, 5, 6, 7]);
});

test('single spikes among a million samples are kept with few points', () => {
  const size = 1_000_000;
  const time = times(size);
  const values = time.map((t) => Math.sin(40 * t));
  values[123_457] = 7;
  values[876_543] = -9;
  const shown = decimate(time, values, 0, time[size - 1], 800);
  expect(shown.dense).toBe(true);
  expect(extent([shown.y])).toEqual([-9, 7]);
  expect(shown.x[shown.y.indexOf(7)]).toBe(time[123_457]);
  expect(shown.x.length).toBeLessThanOrEqual(2 * 800 + 6);
  expect([...shown.x]).toEqual([...shown.x].sort((a, b) => a - b));
});

test('every column keeps its minimum and maximum', () => {
  const time = times(10_000);
  const values = time.map((t) => Math.sin(1e4 * t * t));
  const shown = decimate(time, values, 0, time[9999], 100);
  const width = time[9999] / 100;
  for (let column = 0; column < 100; ++column) {
    const inside = (x: number): boolean => x >= column * width && x < (column + 1) * width;
    const all = extent([values.filter((_value, i) => inside(time[i]))]);
    expect(extent([shown.y.filter((_value, i) => inside(shown.x[i]))]), `column ${column}`).toEqual(all);
  }
});

test('each sample is read once, so the time is proportional to their number', () => {
  const reads = (size: number): number => {
    let count = 0;
    const values = new Proxy(new Float64Array(size), {
      get(target, key) {
        if (typeof key === 'string' && /^\d+$/.test(key)) ++count;
        return Reflect.get(target, key, target) as unknown;
      },
    });
    decimate(times(size), values, 0, size, 50);
    return count / size;
  };
  expect(reads(20_000)).toBeLessThan(8);
  expect(reads(80_000) / reads(20_000)).toBeCloseTo(1, 1);
});

test('a gap breaks the line, and NaN does not hide the neighbouring samples', () => {
  const shown = decimate(Float64Array.of(0, 1, 2, 10, 11), Float64Array.of(1, 2, 3, 4, 5), 0, 11, 100, 3);
  expect([...shown.y]).toEqual([1, 2, 3, NaN, 4, 5]);
  const time = times(1000);
  const values = time.map((_t, i) => (i % 2 === 0 ? NaN : i));
  expect(extent([decimate(time, values, 0, 1, 20).y])).toEqual([1, 999]);
});

test('an empty range is empty', () => {
  expect(decimate(new Float64Array(0), new Float64Array(0), 0, 1, 10).x.length).toBe(0);
});

test('the area between two curves keeps the extremes of both in each column', () => {
  const time = Float64Array.from({ length: 8 }, (_unused, i) => i);
  const low = Float64Array.from([0, -1, 0, 0, 0, 0, -3, 0]);
  const high = Float64Array.from([1, 1, 2, 1, 1, 5, 1, 1]);
  const area = decimateArea(time, low, high, 0, 7, 4);
  expect([...area.x]).toEqual([0.5, 2.5, 4.5, 6.5]);
  expect([...area.low]).toEqual([-1, 0, 0, -3]);
  expect([...area.high]).toEqual([1, 2, 5, 1]);
  expect([...decimateArea(time, low, high, 2, 3, 100).x]).toEqual([1, 2, 3]);
});
