// SPDX-License-Identifier: Apache-2.0

/**
 * Rate of N samples by central differences, unit of the values per s; one-sided at both ends. NaN across intervals
 * longer than `gap` [s].
 */
export function centralDifferences(time: Float64Array, values: Float64Array, gap = Infinity): Float64Array {
  const last = values.length - 1;
  return values.map((_value, i) => {
    const before = Math.max(0, i - 1);
    const after = Math.min(last, i + 1);
    const interval = time[after] - time[before];
    return interval > 0 && interval <= 2 * gap ? (values[after] - values[before]) / interval : NaN;
  });
}

/** Every n-th value, with the smallest n that leaves at most `most` values. */
export function thinned(values: Float64Array, most: number): Float64Array {
  const stride = Math.ceil(values.length / most);
  if (stride <= 1) return values;
  return Float64Array.from({ length: Math.ceil(values.length / stride) }, (_unused, i) => values[i * stride]);
}
