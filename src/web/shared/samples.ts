// SPDX-License-Identifier: Apache-2.0
/** Samples as typed arrays. null becomes NaN, which no plot draws. */

import type { ModelSeries, MotionJson, Num, Series } from './result_types';

/** Arrays of N samples: time in s on the file's clock, readings in `unit`. A missing array of a model is null. */
export interface Samples {
  time: Float64Array;
  measured: Float64Array;
  unit: string;
  models: Map<string, ModelSamples>;
  /** Fitted motions by model, where the samples do not show them. */
  motions: Map<string, Motion>;
}

/** M points of a fitted motion: time in s on the file's clock, angle from the equilibrium, rate in its unit per s. */
export interface Motion {
  time: Float64Array;
  angle: Float64Array;
  rate: Float64Array;
  /** What the sensor shows, in the unit of the readings. */
  reading: Float64Array;
}

export interface ModelSamples {
  fitted: Float64Array | null;
  fittedError: Float64Array | null;
  residual: Float64Array | null;
  linear: Float64Array | null;
  nonlinear: Float64Array | null;
}

/** The values as an array; null unless there are `size` of them. */
export function toArray(values: readonly Num[] | null | undefined, size: number): Float64Array | null {
  if (!values || values.length !== size) return null;
  const array = new Float64Array(size);
  for (let i = 0; i < size; ++i) array[i] = values[i] ?? NaN;
  return array;
}

/** measured - fitted, for a series without residuals. */
function differences(measured: Float64Array, fitted: Float64Array | null): Float64Array | null {
  return fitted && measured.map((value, i) => value - fitted[i]);
}

function modelSamples(model: ModelSeries, measured: Float64Array): ModelSamples {
  const size = measured.length;
  const fitted = toArray(model.fitted, size);
  return {
    fitted,
    fittedError: toArray(model.fitted_std_error, size),
    residual: toArray(model.residual, size) ?? differences(measured, fitted),
    linear: toArray(model.linear_closed_form, size),
    nonlinear: toArray(model.nonlinear_closed_form, size),
  };
}

function toMotion(json: MotionJson): Motion | null {
  const size = json.angle.length;
  const [angle, rate, reading] = [json.angle, json.rate, json.reading].map((values) => toArray(values, size));
  if (!angle || !rate || !reading) return null;
  return { time: angle.map((_angle, i) => json.start_s + i * json.interval_s), angle, rate, reading };
}

function toMotions(series: Series): Map<string, Motion> {
  const motions = new Map<string, Motion>();
  for (const [model, json] of Object.entries(series.motions ?? {})) {
    const motion = json && toMotion(json);
    if (motion) motions.set(model, motion);
  }
  return motions;
}

export function toSamples(series: Series | null): Samples | null {
  const size = series?.time_s?.length ?? 0;
  const measured = toArray(series?.measured, size);
  if (!series || size < 2 || !measured) return null;
  const models = new Map(Object.entries(series.models ?? {}).map(([name, model]) => [name, modelSamples(model, measured)]));
  const time = Float64Array.from(series.time_s);
  return { time, measured, unit: series.unit, models, motions: toMotions(series) };
}

/** First index with time >= t; N if there is none. */
export function lowerBound(time: Float64Array, t: number): number {
  let low = 0;
  let high = time.length;
  while (low < high) {
    const middle = (low + high) >>> 1;
    if (time[middle] < t) low = middle + 1;
    else high = middle;
  }
  return low;
}

/** Median interval between samples, s, from at most 2001 intervals. */
export function medianInterval(time: Float64Array): number {
  const stride = Math.max(1, Math.floor((time.length - 1) / 2000));
  const steps: number[] = [];
  for (let i = 1; i < time.length; i += stride) steps.push(time[i] - time[i - 1]);
  steps.sort((a, b) => a - b);
  return steps[steps.length >> 1] ?? 0;
}

/** Root mean square of the finite values; NaN if there are none. */
export function rootMeanSquare(values: Float64Array): number {
  let sum = 0;
  let count = 0;
  for (const value of values) {
    if (!Number.isFinite(value)) continue;
    sum += value * value;
    ++count;
  }
  return Math.sqrt(sum / count);
}

/** Minimum and maximum of all arrays without NaN; null if there are no values. */
export function extent(arrays: Iterable<ArrayLike<number>>): [number, number] | null {
  let low = Infinity;
  let high = -Infinity;
  for (const array of arrays) {
    for (let i = 0; i < array.length; ++i) {
      if (array[i] < low) low = array[i];
      if (array[i] > high) high = array[i];
    }
  }
  return low <= high ? [low, high] : null;
}
