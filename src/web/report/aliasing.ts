// SPDX-License-Identifier: Apache-2.0
/** How a swing looks when it is sampled less than twice a period. MODEL.md eq. (6.13). */

import type { Turn } from './envelope';

/** f_a = |f - k f_s|, k the integer nearest f / f_s. All in Hz. */
export function apparentFrequency(frequency: number, rate: number): { apparent: number; cycles: number } {
  const cycles = Math.round(frequency / rate);
  return { apparent: Math.abs(frequency - cycles * rate), cycles };
}

/**
 * The slow swing that samples at even intervals show instead of the true one: A(t) cos(φ(t) - 2π k f_s (t - t_0)).
 * A(t) and φ(t) are amplitude and phase of the true swing; φ grows by π from one turning point to the next. t_0 is the
 * time of a sample, so the slow swing goes through all samples. `sign` is the sign of the first turning point. Returns
 * values about 0 at `times`, NaN before the first and after the last turning point.
 */
export function apparentSwing(
  turns: Turn[],
  sign: number,
  times: Float64Array,
  cycles: number,
  rate: number,
  sampleTime: number,
): Float64Array {
  const values = new Float64Array(times.length).fill(NaN);
  let at = 0;
  times.forEach((t, i) => {
    while (at + 2 < turns.length && turns[at + 1].time < t) ++at;
    const [one, other] = [turns[at], turns[at + 1]];
    if (!other || t < one.time || t > other.time) return;
    const share = (t - one.time) / (other.time - one.time);
    const phase = Math.PI * (at + share) - 2 * Math.PI * cycles * rate * (t - sampleTime);
    values[i] = sign * (one.amplitude + share * (other.amplitude - one.amplitude)) * Math.cos(phase);
  });
  return values;
}
