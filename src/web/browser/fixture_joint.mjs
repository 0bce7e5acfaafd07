// SPDX-License-Identifier: Apache-2.0
// Results and series of several recordings that were fitted together, for the tests.

import { failed, failedPart, makeResult, seriesOf, warning } from './fixture.mjs';

/** Estimates from each recording alone, near the joint estimate. `odd`: the last inertia is far from that estimate. */
function agreementOf(name, { estimate, std_error: error, unit }, count, odd) {
  const size = error ?? 1e-4;
  const shift = (k) => (odd && name === 'inertia' && k === count - 1 ? 40 : [-1, 0.5, 1.25][k % 3]);
  const known = (k) => !(name === 'coulomb' && k === 1);
  return {
    unit,
    random_effects: {
      mean: estimate + size,
      std_error: 2 * size,
      interval95: [estimate - 5 * size, estimate + 7 * size],
    },
    recordings: Array.from({ length: count }, (_unused, k) =>
      known(k)
        ? { estimate: estimate + shift(k) * size, std_error: 2 * size, z: 0.5 * shift(k) }
        : { estimate: null, std_error: null, z: null, reason: 'the recording on its own does not determine it' },
    ),
  };
}

const verdictOf = (count, odd) =>
  odd
    ? `the recordings do not agree on inertia (chi-square 1.23e+03, 4 degrees of freedom, p < 1e-99); recording ${count} disagrees with the others: fit the others without it`
    : 'the recordings agree on inertia, viscous (chi-square 3.5, 4 degrees of freedom, p 0.48)';

function homogeneityOf(parameters, count, odd) {
  return {
    agrees: !odd,
    outliers: odd ? [count] : [],
    verdict: verdictOf(count, odd),
    parameters: Object.fromEntries(
      Object.entries(parameters).map(([name, parameter]) => [name, agreementOf(name, parameter, count, odd)]),
    ),
  };
}

/** The summary of a joint fit: only shared parameters, and whether the recordings agree. */
function jointSummary({ summary, shared }, count, odd) {
  const own = verdictOf(count, odd);
  return {
    ...summary,
    agreement: `${own.slice(0, 1).toUpperCase()}${own.slice(1)}.`,
    ...(odd ? { level: 'caution', verdict: 'The errors below assume that the recordings agree: do not quote them.' } : {}),
    parameters: summary.parameters.filter(({ name }) => shared.includes(name)),
    warnings: ['recording 2 (folder/run2.csv): readings are missing in 1 place'],
  };
}

/** Makes a joint fit of `count` recordings from the fit of one. */
const jointFit = (fit, count, odd) => ({
  ...fit,
  summary: jointSummary(fit, count, odd),
  homogeneity: homogeneityOf(fit.parameters, count, odd),
});

/** The part of recording k, counted from 0, made from that of one recording. */
function partOf({ parameters, noise, ...rest }, k) {
  const { release_angle: angle, release_time: time } = parameters;
  return {
    ...rest,
    amplitude_rad: 0.1 * (k + 1),
    parameters: {
      ...parameters,
      release_angle: { ...angle, estimate: 0.4 + 0.01 * k },
      release_time: { ...time, estimate: 1 + 0.5 * k },
    },
    noise: { ...noise, sigma_rad: 0.003 + 0.001 * k },
  };
}

/** The result of `count` recordings. `odd`: the last one disagrees. */
export function makeJointResult({ models = ['viscous', 'coulomb', 'drag'], count = 3, odd = false } = {}) {
  const one = makeResult({ models });
  const [recording] = one.recordings;
  return {
    ...one,
    recordings: Array.from({ length: count }, (_unused, k) => ({
      ...recording,
      path: `folder/run${k + 1}.csv`,
      sha256: `${k + 1}a`.repeat(32),
      calibration: k === 0 ? null : recording.calibration,
      fits: recording.fits.map((fit) => partOf(fit, k)),
    })),
    fits: one.fits.map((fit) => jointFit(fit, count, odd)),
    warnings: [
      ...(odd ? [warning('recordings_disagree', verdictOf(count, odd))] : []),
      warning('gaps', 'recording 2 (folder/run2.csv): readings are missing in 1 place', { recordings: [2] }),
    ],
  };
}

/** The series of makeJointResult(). Each recording is released 0.5 s later than the previous one. */
export function makeJointSeries({ models = ['viscous', 'coulomb', 'drag'], count = 3, samples = 2000 } = {}) {
  return Array.from({ length: count }, (_unused, k) => {
    const series = seriesOf({ models, samples });
    const later = (t) => Math.round((t + 0.5 * k) * 1e7) / 1e7;
    return { ...series, time_s: series.time_s.map(later), peaks: series.peaks.map((peak) => ({ ...peak, time_s: later(peak.time_s) })) };
  });
}

/** A joint fit that failed: only the fits of the single recordings remain. */
export function makeJointFailed() {
  const result = makeJointResult({ models: ['coulomb'] });
  const reason = 'the pendulum never moves';
  const unknown = 'fewer than two recordings tell them';
  const homogeneity = {
    agrees: null,
    outliers: [],
    verdict: `not tested: ${unknown}`,
    parameters: {},
  };
  return {
    ...result,
    recordings: result.recordings.map((one) => ({
      ...one,
      calibration: null,
      closed_forms: null,
      fits: one.fits.map((fit) => failedPart(fit)),
    })),
    fits: result.fits.map((fit) => ({
      ...failed(fit, `recording 2: ${reason}`, { agreement: `Not tested: ${unknown}.` }),
      homogeneity,
    })),
    warnings: [],
  };
}
