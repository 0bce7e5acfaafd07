// SPDX-License-Identifier: Apache-2.0

const kMostSamples = 200_000;

/**
 * Correlation of values with those k further on, k = 0 ... lags:
 *   r_k = Σ (x_i - m)(x_{i+k} - m) / Σ (x_i - m)²,
 * the estimate of Box & Jenkins. Of more than 200000 values the first so many; values that are NaN count as the mean.
 * Empty where nothing varies. `used`: how many values took part.
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

/** Mean, standard deviation (N - 1) and number of the values that are finite. */
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
