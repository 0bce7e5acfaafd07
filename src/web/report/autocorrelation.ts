// SPDX-License-Identifier: Apache-2.0

const kMostSamples = 200_000;

/**
 * Autocorrelation at the lags k = 0 ... lags, as Box & Jenkins estimate it:
 *   r_k = Σ (x_i - m)(x_{i+k} - m) / Σ (x_i - m)².
 * Only the first 200000 values are used. NaN counts as the mean m. `r` is empty if all values are equal. `used` is the
 * number of values that were used.
 */
export function autocorrelation(values: Float64Array, lags: number): { r: number[]; used: number } {
  const part = values.subarray(0, kMostSamples);
  const { mean, count } = moments(part);
  const x = part.map((value) => (Number.isFinite(value) ? value - mean : 0));
  const most = Math.min(lags, count - 1);
  const total = laggedSum(x, 0);
  if (!(total > 0)) return { r: [], used: count };
  const r: number[] = [];
  for (let k = 0; k <= most; ++k) r.push(laggedSum(x, k) / total);
  return { r, used: count };
}

function laggedSum(x: Float64Array, lag: number): number {
  let sum = 0;
  for (let i = lag; i < x.length; ++i) sum += x[i] * x[i - lag];
  return sum;
}

/** Mean, standard deviation (N - 1) and number of the finite values. */
export function moments(values: ArrayLike<number>): { mean: number; deviation: number; count: number } {
  let count = 0;
  let mean = 0;
  let squares = 0;
  for (let i = 0; i < values.length; ++i) {
    if (!Number.isFinite(values[i])) continue;
    const step = values[i] - mean;
    mean += step / ++count;
    squares += step * (values[i] - mean);
  }
  return { mean, deviation: count > 1 ? Math.sqrt(squares / (count - 1)) : 0, count };
}
