// SPDX-License-Identifier: Apache-2.0
/** Amplitudes of the swing: turning points, and curves to compare them with. */

import type { Recording, Series } from '../shared/result_types';

/** A turning point: time [s], amplitude and its standard error in the unit of the readings. */
export interface Turn {
  time: number;
  amplitude: number;
  error: number | null;
}

/** Zero of the readings at time t [s]: the zero parameter plus its drift since the first used sample. */
export type Zero = (t: number) => number;

/**
 * |reading - zero| at the turning points of the series: of `peaks`, which have errors, or of `extrema` if there are no
 * peaks.
 */
export function measuredTurns(series: Series, zero: Zero): Turn[] {
  const turns: Turn[] = [];
  for (const peak of series.peaks ?? []) {
    const value =
      peak.angle_rad ?? peak.rate_rad_s ?? peak.angle_counts ?? peak.angle_volts ?? peak.rate_counts ?? peak.rate_volts;
    if (typeof value !== 'number') continue;
    turns.push({ time: peak.time_s, amplitude: Math.abs(value - zero(peak.time_s)), error: peak.std_error });
  }
  if (turns.length > 0) return turns;
  return (series.extrema ?? []).map(([time, value]) => ({
    time,
    amplitude: Math.abs(value - zero(time)),
    error: null,
  }));
}

/**
 * Turning points of a smooth curve: the vertex of the parabola through each maximum above the zero, or minimum below it,
 * and its two neighbours.
 */
export function curveTurns(time: Float64Array, values: Float64Array, zero: Zero): Turn[] {
  const turns: Turn[] = [];
  for (let i = 1; i + 1 < values.length; ++i) {
    const [before, here, after] = [values[i - 1], values[i], values[i + 1]];
    const away = here - zero(time[i]);
    const top = away > 0 ? here >= before && here > after : here <= before && here < after;
    if (!top || !Number.isFinite(before + here + after)) continue;
    const curvature = before - 2 * here + after;
    const shift = curvature === 0 ? 0 : (0.5 * (before - after)) / curvature;
    const t = time[i] + shift * 0.5 * (time[i + 1] - time[i - 1]);
    const value = here - 0.25 * (before - after) * shift;
    turns.push({ time: t, amplitude: Math.abs(value - zero(t)), error: null });
  }
  return turns;
}

/** The zero of a fit; 0 if it has no such parameter. `start`: time of the first used sample, s. */
export function zeroOf(parameters: Record<string, { estimate: number | null }>, start: number): Zero {
  const value = parameters.zero_angle?.estimate ?? parameters.rate_bias?.estimate ?? 0;
  const drift = parameters.zero_drift?.estimate ?? parameters.bias_drift?.estimate ?? 0;
  return (t) => value + drift * (t - start);
}

/** Decay rate of the amplitudes by the log decrement, δ ω_d / 2π, 1/s; null without a log decrement. */
export function decrementRate({ closed_forms: forms, clock_scale: scale }: Recording): number | null {
  const linear = forms?.linear;
  const decrement = linear?.log_decrement?.estimate;
  const frequency = linear?.damped_frequency?.estimate;
  if (typeof decrement !== 'number' || typeof frequency !== 'number') return null;
  return (decrement * frequency * (scale || 1)) / (2 * Math.PI);
}

/**
 * A exp(-rate t) through the turning points. A is from the mean logarithm of the first `most` turning points, which are
 * those that the log decrement was computed from. Returns amplitudes at `times`.
 */
export function exponentialThrough(turns: Turn[], rate: number, times: number[], most = Infinity): number[] {
  const used = turns.slice(0, most).filter((turn) => turn.amplitude > 0);
  if (used.length === 0) return times.map(() => NaN);
  const logs = used.map((turn) => Math.log(turn.amplitude) + rate * turn.time);
  const mean = logs.reduce((sum, value) => sum + value, 0) / logs.length;
  return times.map((t) => Math.exp(mean - rate * t));
}
