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
  };
}

/** The fit of the model with this name to one recording. */
export function fitOf(model) {
  const parameters = sharedParameters(model);
  const errors = errorsOf(model);
  return {
    model,
    status: 'converged',
    reason: 'the estimates are within 0.1 standard errors of the minimum',
    summary: summaryOf(model),
    shared: Object.keys(parameters),
    parameters,
    ...errors,
    identifiability: [],
    statistics: { rms_residual_rad: kSigma },
    homogeneity: null,
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
      sigma_rad: kSigma,
    },
    constancy: {
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
          { parameter: 'inertia', unit: 'kg m^2' },
          { parameter: 'viscous', unit: 'N m s/rad' },
        ],
      },
    },
  };
}
