// SPDX-License-Identifier: Apache-2.0
// A fit with all optional parts, for the tests.

import { kAmplitude, kRelease, kSigma, kZero } from './fixture_motion.mjs';

const parameter = (estimate, stdError, unit, more = {}) => ({
  estimate,
  std_error: stdError,
  unit,
  fixed: false,
  at_bound: false,
  systematic_std_error: null,
  total_std_error: stdError,
  error_budget: stdError === null ? null : { noise: stdError },
  interval95: stdError === null ? null : [estimate - 1.96 * stdError, estimate + 1.96 * stdError],
  ...more,
});

// Of the variance of the inertia 99.5 % is from the rig: (4.1e-5 / 2.77e-6)² = 219. The total is 4.109e-5.
const kRigError = { systematic_std_error: 4.1e-5, total_std_error: 4.109e-5 };

const quantity = (name, symbol, value, error, unit, source) => ({ name, symbol, value, error, unit, source });

/** The answer, with the parameters of fitOf() rounded by hand. */
function summaryOf(model) {
  const warnings = ['viscous is weakly identifiable'];
  const first = [
    quantity('inertia', 'I_O', '0.07900', '0.00004', 'kg m^2', 'masses and length'),
    quantity('viscous', 'b', '0.00300', '0.00010', 'N m s/rad', 'noise'),
  ];
  const coulomb = quantity('coulomb', 'τ_c', '0.00399', '0.00011', 'N m', 'noise');
  const drag = quantity('drag', 'c', '0', '', 'N m s^2/rad^2', 'at its bound');
  const rest = [
    quantity('release_angle', 'θ_r', '22.918', '0.011', 'deg', 'noise'),
    quantity('release_time', 't_r', '1.00000', '0.00010', 's', 'noise'),
    quantity('zero_angle', 'z', '0.573', '', 'deg', 'fixed'),
  ];
  return {
    verdict:
      model === 'viscous'
        ? 'The law viscous does not describe all readings: residuals of 0.172 deg (rms) exceed the noise.'
        : `The law ${model} describes the readings: residuals of 0.172 deg (rms) are noise.`,
    level: model === 'viscous' ? 'caution' : 'good',
    agreement: '',
    parameters: [...first, ...(model === 'viscous' ? [] : [coulomb]), ...(model === 'drag' ? [drag] : []), ...rest],
    derived: [
      quantity('period of small swings', '', '1.3150', '0.0003', 's', ''),
      quantity('Q', '', '(1.250', '0.031)e+02', '', ''),
    ],
    equation: "0.07900 th'' + 0.00300 th' + 1.803 sin th = 0",
    units: '',
    textbook: "The textbook's log decrement gives I_O 0.0798 (1 % more: it assumes small angles).",
    remarks: '',
    assumptions: ['times in s (--time_column t:ms)'],
    warnings: model === 'drag' ? [...warnings, 'at the bound 0: drag'] : warnings,
  };
}

/** What all recordings share. */
const sharedParameters = (model) => ({
  inertia: parameter(0.07899964917915511, 2.7734679124217884e-6, 'kg m^2', {
    ...kRigError,
    error_budget: { noise: 2.7734679124217884e-6, rig: 4.1e-5 },
  }),
  viscous: parameter(0.0030015526573362564, 9.688622251656585e-5, 'N m s/rad'),
  ...(model === 'viscous' ? {} : { coulomb: parameter(0.0039898698406139015, 0.00011368461537974497, 'N m') }),
  ...(model === 'drag'
    ? {
        drag: parameter(0, null, 'N m s^2/rad^2', {
          at_bound: true,
          interval95: [0, 0.001],
          reason: 'at its bound 0',
        }),
      }
    : {}),
});

/** Parts that are the same for the shared and for all parameters: the start of the recording has no correlations here. */
function errorsOf(model) {
  const names = ['inertia', 'viscous', ...(model === 'viscous' ? [] : ['coulomb'])];
  const matrix = names.map((_row, i) => names.map((_column, j) => (i === j ? 1 : i + j === 3 ? -0.995 : 0.24)));
  return {
    covariance: { names, matrix },
    correlation: { names, matrix },
    systematic_covariance: { names: [], matrix: [] },
    std_error_method: "covariance sigma^2 (J'J)^-1, residuals taken as independent",
  };
}

const kStatistics = {
  rms_residual_rad: kSigma,
  log_likelihood: -2889,
  aic: 5792.3,
  aicc: 5792.4,
  bic: 5831.6,
  effective_samples: 2000,
};

/** The fit of the model with this name to one recording. */
export function fitOf(model) {
  const parameters = sharedParameters(model);
  const errors = errorsOf(model);
  return {
    model,
    status: 'converged',
    reason: 'the estimates are within 0.1 standard errors of the minimum',
    equation: "0.079 th'' + 0.003 th' + 1.803 sin th = 0",
    summary: summaryOf(model),
    shared: Object.keys(parameters),
    parameters,
    derived: {
      gravity_over_inertia: { estimate: 22.83, std_error: 0.0008, interval95: [22.828, 22.832], unit: '1/s^2' },
      damping_ratio: { estimate: 0.004, std_error: 0.0001, interval95: null, unit: '1' },
    },
    ...errors,
    interval_method: 'estimate ± 1.961 standard errors',
    identifiability: errors.covariance.names.map((name) => ({
      parameter: name,
      verdict: name === 'viscous' ? 'weakly identifiable' : 'identifiable',
      direction: [],
      advice: name === 'viscous' ? 'record for longer' : null,
    })),
    statistics: kStatistics,
    homogeneity: null,
    solver: { iterations: 5, evaluations: 30, termination: 'Function tolerance reached.' },
  };
}

/** The part of fitOf() that belongs to the recording. */
export function recordingFitOf(model) {
  return {
    model,
    amplitude_rad: 0.2,
    parameters: {
      release_angle: parameter(kAmplitude, 0.0002, 'rad'),
      release_time: parameter(kRelease, 0.0001, 's'),
      zero_angle: parameter(kZero, null, 'rad', { fixed: true, reason: 'held by --fix' }),
    },
    ...errorsOf(model),
    identifiability: [],
    noise: {
      model: 'gaussian',
      reason: 'the noise is larger than the resolution, so readings are treated as continuous',
      sigma_rad: kSigma,
      sigma_std_error: 5e-5,
      resolution_rad: 0.0035,
      saturated_samples: 0,
      lag1_correlation: -0.03,
      correlation: 'white',
    },
    statistics: { ...kStatistics, durbin_watson: 2.07, ljung_box_p: 0.68, runs_p: 0.83 },
    closed_form: [
      {
        quantity: 'inertia_small_angle',
        method: 'damped period and log decrement, small angles',
        closed_form: 0.0798,
        std_error: 4.4e-5,
        fit: 0.078999,
        fit_std_error: 2.8e-6,
        unit: 'kg m^2',
        z: 19.1,
        agrees: false,
        reason: 'differs by +0.00084 kg m^2: by finite amplitude',
      },
      {
        quantity: 'inertia_geometry',
        method: 'the rig file',
        closed_form: 0.0761,
        std_error: null,
        fit: 0.078999,
        fit_std_error: 2.8e-6,
        unit: 'kg m^2',
        z: null,
        agrees: null,
        reason: 'no errors to compare it with',
      },
      {
        quantity: 'inertia_turning_points',
        method: 'least squares over all turning points',
        closed_form: 0.078997,
        std_error: 1.7e-5,
        fit: 0.078999,
        fit_std_error: 2.8e-6,
        unit: 'kg m^2',
        z: -0.2,
        agrees: true,
        reason: null,
      },
    ],
    constancy: {
      verdict: 'inertia and friction are constants of the recording',
      constant: true,
      halves: {
        statistic: 1.7,
        dof: 1,
        p: 0.43,
        rows: [
          {
            parameter: 'inertia',
            unit: 'kg m^2',
            first: 0.079,
            first_std_error: 4e-6,
            second: 0.078998,
            second_std_error: 5e-6,
            z: 0.4,
          },
        ],
      },
      amplitude: {
        windows: [0.4, 0.3, 0.2].map((amplitude, i) => ({
          from_s: 4 * i,
          to_s: 4 * i + 4,
          amplitude_rad: amplitude,
          inertia: 0.079 + 1e-6 * i,
          inertia_std_error: 3e-6,
          friction: 0.003,
          friction_std_error: 1e-4,
        })),
        trends: [
          { parameter: 'inertia', unit: 'kg m^2', slope: 1e-5, slope_std_error: 2e-5, span: 0.0012, p: 0.6 },
          { parameter: 'viscous', unit: 'N m s/rad', slope: 1e-5, slope_std_error: 2e-4, span: 0.0012, p: 0.9 },
        ],
      },
    },
    separate: 'converged',
  };
}
