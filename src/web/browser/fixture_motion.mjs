// SPDX-License-Identifier: Apache-2.0
// A motion in closed form: A exp(-rate t) cos(2 π t / period) after the release.

/** Pseudorandom numbers in (0, 1), by Park & Miller's generator. */
export function seeded(seed) {
  let state = seed;
  return () => (state = (state * 48271) % 2147483647) / 2147483647;
}

export const kRelease = 1; // s
export const kAmplitude = 0.4; // rad
export const kRate = 0.03; // 1/s
export const kPeriod = 1.315; // s
export const kSigma = 0.003; // rad
export const kZero = 0.01; // rad

export const motion = (t) => {
  const since = Math.max(0, t - kRelease);
  return kZero + kAmplitude * Math.exp(-kRate * since) * Math.cos((2 * Math.PI * since) / kPeriod);
};
