// SPDX-License-Identifier: Apache-2.0
/** What a swing looks like that is sampled less than twice a period: MODEL.md eq. (44). */

import type { Turn } from './envelope';

/** f_a = |f - k f_s|, k the integer nearest f / f_s. All in Hz. */
export function apparentFrequency(frequency: number, rate: number): { apparent: number; cycles: number } {
  const cycles = Math.round(frequency / rate);
  return { apparent: Math.abs(frequency - cycles * rate), cycles };
}

/**
 * The slow swing that even samples show instead of the true one: with amplitude A(t) and phase φ(t) of the true swing
 * between its turning points (φ grows by π from one to the next), A cos(φ - 2π k f_s (t - t_0)), t_0 a sample's time.
 * So it goes through the samples. `sign`: of the first turning point. Returns values about 0 at `times`; NaN before the
 * first turning point and after the last.
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
