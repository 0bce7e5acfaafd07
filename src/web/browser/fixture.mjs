// SPDX-License-Identifier: Apache-2.0
// Results and series of one recording for the tests.

import { fitOf, recordingFitOf } from './fixture_fit.mjs';
import { kPeriod, kRate, kRelease, kSigma, kZero, motion, seeded } from './fixture_motion.mjs';

/** A warning, by default about the whole result. */
export const warning = (code, text, more = {}) => ({
  code,
  message: text,
  text,
  finding: text,
  explanation: null,
  advice: null,
  flags: [],
  assumed: null,
  law: null,
  recordings: [],
  parameters: [],
  ...more,
});

/** A warning about one law. */
const ofLaw = (law, code, text) => warning(code, text, { message: `${law}: ${text}`, law });

function comparisonOf(fits, recommended) {
  const prediction = (standardized) => ({ rms_rad: 0.003 * standardized, standardized, samples: 900 });
  const rows = fits.map((fit, i) => ({
    model: fit.model,
    is_compared: i > 0,
    parameters: 5 + i,
    rms_residual_rad: kSigma,
    log_likelihood: -2889,
    aic: 1,
    aicc: 1,
    bic: 1,
    delta_bic: i === 0 ? null : 1.9 * (i - 1),
    akaike_weight: i === 0 ? null : 0.5,
    cross_validation: prediction(1.01),
    forward_prediction: i === 0 ? null : prediction(1.02),
    lag1_correlation: 0.01,
    ljung_box_p: 0.4,
    lack_of_fit: i === 0,
    ...(i === 0 ? { reason: 'it leaves more than noise' } : {}),
  }));
  return {
    recommended,
    reason: `the simplest law whose residuals are noise`,
    criterion: 'bic',
    criterion_reason: 'residuals are independent',
    likelihood: 'independent',
    effective_samples: 2000,
    rows,
    tests: [
      {
        simpler: 'viscous',
        richer: 'coulomb',
        added: ['coulomb'],
        statistic: 812.1,
        null: 'half χ²(0), half χ²(1)',
        p: 1e-150,
      },
      {
        simpler: 'coulomb',
        richer: 'drag',
        added: ['drag'],
        statistic: null,
        null: 'none',
        p: null,
        reason: 'drag did not converge',
      },
    ],
  };
}

/** A result of these models with all optional parts. */
export function makeResult({
  models = ['viscous', 'coulomb', 'drag'],
  samples = 2000,
  rate = 100,
  path = 'folder/run.csv',
} = {}) {
  const fits = models.map(fitOf);
  const end = (samples - 1) / rate;
  return {
    schema_version: 3,
    tool: { name: 'fit_pendulum', version: '0.1.0' },
    rig: { bob_mass: { value: 0.38, std_dev: 0.001 }, rod_mass: 0.095, rod_length: 0.43, gravity: 9.81 },
    recordings: [
      {
        path,
        sha256: 'ab'.repeat(32),
        samples,
        used_samples: samples,
        duration_s: end,
        sample_rate_hz: rate,
        resolution_rad: 0.0035,
        resolution_source: 'file',
        clock_scale: 1,
        clock_scale_std_dev: 0,
        sensor: null,
        window_s: [0, end],
        window_reason: 'begins: held, then released; ends: the end of the recording',
        releases: [[0, end]],
        release: 1,
        start: 'release',
        sampling: {
          rate_hz: rate,
          jitter_s: 0,
          gaps: 0,
          longest_gap_s: 0,
          frequency_hz: 1 / kPeriod,
          apparent_frequency_hz: 1 / kPeriod,
          expected_frequency_hz: null,
          samples_per_period: rate * kPeriod,
          nyquist_margin: (rate * kPeriod) / 2,
          start_counts: 240,
          end_counts: 100,
          saturated_samples: 0,
        },
        calibration: {
          schema_version: 1,
          input: 'counts',
          angle_unit: 'deg',
          coefficients: [-49.6077, 0.198544],
          covariance: null,
        },
        closed_forms: {
          model: models[0],
          linear: {
            damped_frequency: { estimate: (2 * Math.PI) / kPeriod, std_error: 0.001, unit: 'rad/s' },
            log_decrement: { estimate: kRate * kPeriod, std_error: 0.0005, unit: '1' },
            periods: 12,
          },
          decrement: null,
          envelopes: [{ term: 'viscous', shape: 'exponential', chi_square: 40, dof: 39, p: 0.43 }],
          envelope: 'exponential (viscous friction alone, p 0.43)',
          turning_points: 20,
          noise_rad: kSigma,
        },
        fits: models.map(recordingFitOf),
      },
    ],
    fits,
    comparison: models.length > 1 ? comparisonOf(fits, models[1]) : null,
    warnings: [
      ...(models.length > 1 ? [ofLaw('viscous', 'lack_of_fit', 'the residuals are more than noise; try another law')] : []),
      warning('weakly_identifiable', 'viscous is weakly identifiable; record for longer'),
      ...(models.includes('drag') ? [ofLaw('drag', 'at_bound', 'at the bound 0: drag; a simpler law has smaller errors')] : []),
    ],
  };
}

/** The series of one recording of makeResult() with the same options. `band`: with standard errors of the fitted readings. */
export function seriesOf({ models = ['viscous', 'coulomb', 'drag'], samples = 2000, rate = 100, band = null } = {}) {
  const random = seeded(1);
  const noise = () => kSigma * (random() + random() + random() + random() + random() + random() - 3) * Math.SQRT2;
  const round = (x) => Math.round(x * 1e7) / 1e7;
  const time = Array.from({ length: samples }, (_unused, i) => round(i / rate));
  const fitted = time.map((t) => round(motion(t)));
  const measured = fitted.map((value) => round(value + noise()));
  const residual = measured.map((value, i) => round(value - fitted[i]));
  const peaks = [];
  for (let i = 1; kRelease + (i * kPeriod) / 2 < time[samples - 1] && i < 400; ++i) {
    const t = kRelease + (i * kPeriod) / 2;
    peaks.push({
      number: i,
      time_s: t,
      time_std_error: 0.002,
      angle_rad: motion(t),
      std_error: 0.0012,
      zeta_pair: null,
      zeta: null,
      periods: null,
    });
  }
  const values = [-2, -1, 0, 1, 2].map((k) => 0.003 + k * 1e-4);
  const profile = { value: values, statistic: [4.2, 1.05, 0, 0.97, 3.9], threshold: 3.84 };
  return {
    time_s: time,
    measured,
    unit: 'rad',
    extrema: peaks.map((peak) => [peak.time_s, peak.angle_rad]),
    peaks,
    profiles: Object.fromEntries(models.map((model) => [model, { viscous: profile }])),
    models: Object.fromEntries(
      models.map((model) => [
        model,
        {
          fitted,
          fitted_std_error: band && fitted.map(() => 0.04),
          residual,
          linear_closed_form: fitted.map((value, i) => round(value + 1e-3 * Math.sin(time[i]))),
          nonlinear_closed_form: fitted,
        },
      ]),
    ),
    motions: null,
  };
}

/** The series of makeResult() with the same options. `more`: other members of the recording's series. */
export const makeSeries = (options, more = {}) => [{ ...seriesOf(options), ...more }];

/** The motions of an undersampled makeSeries() with the same options: 60 points a period from the release on. */
export function makeMotions({ models, samples, rate }) {
  const interval_s = kPeriod / 60;
  const size = Math.floor(((samples - 1) / rate - kRelease) / interval_s) + 1;
  const reading = Array.from({ length: size }, (_unused, i) => motion(kRelease + i * interval_s));
  const angle = reading.map((value) => value - kZero);
  const last = size - 1;
  const slope = (i) => (angle[Math.min(i + 1, last)] - angle[Math.max(i - 1, 0)]) / (2 * interval_s);
  const one = { start_s: kRelease, interval_s, angle_unit: 'rad', angle, rate: angle.map((_angle, i) => slope(i)), reading };
  return Object.fromEntries(models.map((model) => [model, one]));
}

const kEmpty = { names: [], matrix: [] };
const kNothing = {
  parameters: {},
  covariance: kEmpty,
  correlation: kEmpty,
  systematic_covariance: kEmpty,
  std_error_method: null,
  identifiability: [],
  statistics: null,
};

/** What remains of a fit that failed: a reason. */
export const failed = (fit, reason, more = {}) => ({
  ...fit,
  ...kNothing,
  status: 'failed',
  reason,
  equation: null,
  summary: {
    ...fit.summary,
    verdict: `No result with ${fit.model} (failed): ${reason}.`,
    level: 'bad',
    parameters: [],
    derived: [],
    equation: '',
    textbook: '',
    remarks: '',
    assumptions: ['times in s (--time_column t:ms)'],
    warnings: [],
    ...more,
  },
  derived: {},
  interval_method: null,
});

/** What remains of it for a recording. */
export const failedPart = (fit, reason) => ({
  ...fit,
  ...kNothing,
  amplitude_rad: null,
  noise: null,
  closed_form: [],
  constancy: null,
  constancy_reason: 'there is no fit',
  separate: `failed: ${reason}`,
});

/** The result of a fit that failed. */
export function makeFailed() {
  const result = makeResult({ models: ['coulomb'] });
  const reason = 'the pendulum never moves';
  const [recording] = result.recordings;
  Object.assign(recording, {
    sampling: null,
    resolution_rad: null,
    resolution_source: null,
    start: null,
    window_reason: null,
    closed_forms: null,
    reason: 'there are no turning points',
    fits: recording.fits.map((fit) => failedPart(fit, reason)),
  });
  return { ...result, fits: result.fits.map((fit) => failed(fit, reason)), warnings: [] };
}
