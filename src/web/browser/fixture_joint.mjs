// SPDX-License-Identifier: Apache-2.0
// Results and series of several recordings that were fitted together, for the tests.

import { makeResult, makeSeries } from './fixture.mjs';

const kShared = ['inertia', 'viscous', 'coulomb', 'drag'];

/** Estimates from each recording alone, near the joint estimate. `odd`: the last inertia is far from that estimate. */
function agreementOf(name, { estimate, std_error: error, unit }, count, odd) {
  const size = error ?? 1e-4;
  const shift = (k) => (odd && name === 'inertia' && k === count - 1 ? 40 : [-1, 0.5, 1.25][k % 3]);
  const known = (k) => !(name === 'coulomb' && k === 1);
  return {
    unit,
    statistic: odd && name === 'inertia' ? 1234.5 : 1.75,
    dof: count - 1,
    p: odd && name === 'inertia' ? 1e-120 : 0.42,
    mean: estimate,
    std_error: size,
    random_effects: {
      mean: estimate + size,
      std_error: 2 * size,
      interval95: [estimate - 5 * size, estimate + 7 * size],
      between_std_dev: 0.5 * size,
      between_interval95: [0, 3 * size],
    },
    runs: Array.from({ length: count }, (_unused, k) =>
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
    statistic: odd ? 1236.25 : 3.5,
    dof: 4,
    p: odd ? 1e-120 : 0.48,
    agrees: !odd,
    outliers: odd ? [count] : [],
    verdict: verdictOf(count, odd),
    parameters: Object.fromEntries(
      Object.entries(parameters).map(([name, parameter]) => [name, agreementOf(name, parameter, count, odd)]),
    ),
    amplitude_dependence: [
      { parameter: 'inertia', slope: 1e-7, std_error: 2e-7, unit: 'kg m^2 / rad^2', p: 0.6, span: 2.4e-5, p_of_remainder: 0.8 },
    ],
  };
}

/** The summary of a joint fit: only shared parameters, and whether the recordings agree. */
function jointSummary(summary, count, odd) {
  const own = verdictOf(count, odd);
  return {
    ...summary,
    agreement: `${own.slice(0, 1).toUpperCase()}${own.slice(1)}.`,
    ...(odd ? { level: 'caution', verdict: 'The errors below assume that the recordings agree: do not quote them.' } : {}),
    parameters: summary.parameters.filter(({ name }) => kShared.includes(name)),
    warnings: ['recording 2 (folder/run2.csv): readings are missing in 1 place'],
  };
}

/** Makes a joint fit of `count` recordings from the fit of one. */
function jointFit(fit, count, odd) {
  const { noise, closed_form, constancy, statistics, parameters, ...rest } = fit;
  const shared = Object.keys(parameters).filter((name) => kShared.includes(name));
  const own = Object.fromEntries(shared.map((name) => [name, parameters[name]]));
  return {
    ...rest,
    equation: "0.079 th'' + 0.003 th' + 1.803 sin th = 0",
    shared,
    summary: jointSummary(fit.summary, count, odd),
    parameters: own,
    statistics: { rms_residual_rad: 0.003, log_likelihood: -1, aic: 2, aicc: 2, bic: 3, effective_samples: 2000 * count },
    homogeneity: homogeneityOf(own, count, odd),
    runs: Array.from({ length: count }, (_unused, k) => ({
      path: `folder/run${k + 1}.csv`,
      release: 1,
      amplitude_rad: 0.1 * (k + 1),
      parameters: {
        ...parameters,
        release_angle: { ...parameters.release_angle, estimate: 0.4 + 0.01 * k },
        release_time: { ...parameters.release_time, estimate: 1 + 0.5 * k },
      },
      covariance: fit.covariance,
      correlation: fit.correlation,
      systematic_covariance: fit.systematic_covariance,
      noise: { ...noise, sigma_rad: 0.003 + 0.001 * k },
      std_error_method: fit.std_error_method,
      identifiability: fit.identifiability,
      statistics,
      closed_form,
      constancy,
      separate: k === 1 ? 'not_identifiable: coulomb is not determined' : 'converged',
    })),
  };
}

/** The result of `count` recordings. `odd`: the last one disagrees. */
export function makeJointResult({ models = ['viscous', 'coulomb', 'drag'], count = 3, odd = false } = {}) {
  const one = makeResult({ models });
  const each = (make) => Array.from({ length: count }, (_unused, k) => make(k));
  return {
    ...one,
    data: each((k) => ({ ...one.data, path: `folder/run${k + 1}.csv`, sha256: `${k + 1}a`.repeat(32) })),
    calibration: each((k) => (k === 0 ? null : one.calibration)),
    closed_forms: each(() => one.closed_forms),
    fits: one.fits.map((fit) => jointFit(fit, count, odd)),
    warnings: [
      ...(odd ? [{ code: 'recordings_disagree', message: verdictOf(count, odd) }] : []),
      { code: 'gaps', message: 'recording 2 (folder/run2.csv): readings are missing in 1 place', recordings: [2] },
    ],
  };
}

/** The series of makeJointResult(). Each recording is released 0.5 s later than the previous one. */
export function makeJointSeries({ models = ['viscous', 'coulomb', 'drag'], count = 3, samples = 2000 } = {}) {
  return Array.from({ length: count }, (_unused, k) => {
    const series = makeSeries({ models, samples });
    const later = (t) => Math.round((t + 0.5 * k) * 1e7) / 1e7;
    return { ...series, time_s: series.time_s.map(later), peaks: series.peaks.map((peak) => ({ ...peak, time_s: later(peak.time_s) })) };
  });
}

/** A joint fit that failed: only the fits of the single recordings remain. */
export function makeJointFailed() {
  const result = makeJointResult({ models: ['coulomb'] });
  const empty = { names: [], matrix: [] };
  const nothing = { parameters: {}, covariance: empty, correlation: empty, systematic_covariance: empty };
  const [fit] = result.fits;
  Object.assign(fit, nothing, {
    status: 'failed',
    reason: 'recording 2: the pendulum never moves',
    summary: {
      ...fit.summary,
      verdict: 'No result with coulomb (failed): recording 2: the pendulum never moves.',
      level: 'bad',
      agreement: 'Not tested: fewer than two recordings tell them.',
      parameters: [],
      derived: [],
      equation: '',
      textbook: '',
      remarks: '',
      assumptions: ['times in s (--time_column t:ms)'],
    },
    equation: null,
    derived: {},
    statistics: null,
    std_error_method: null,
    interval_method: null,
    identifiability: [],
    homogeneity: {
      statistic: null,
      dof: 0,
      p: null,
      reason: 'fewer than two recordings tell them',
      agrees: null,
      outliers: [],
      verdict: 'not tested: fewer than two recordings tell them',
      parameters: {},
      amplitude_dependence: [],
    },
    runs: fit.runs.map((run) => ({
      ...run,
      ...nothing,
      amplitude_rad: null,
      noise: null,
      statistics: null,
      identifiability: [],
      closed_form: [],
      constancy: null,
      constancy_reason: 'there is no fit',
      separate: 'failed: the pendulum never moves',
    })),
  });
  return { ...result, calibration: [null, null, null], closed_forms: [null, null, null], warnings: [] };
}
