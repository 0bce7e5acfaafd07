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

/** What the page reads of a comparison: its table is a section. */
const comparisonOf = (recommended) => ({ recommended, reason: 'the simplest law whose residuals are noise' });

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
        clock_scale: 1,
        window_s: [0, end],
        release: 1,
        sampling: {
          rate_hz: rate,
          frequency_hz: 1 / kPeriod,
          samples_per_period: rate * kPeriod,
          nyquist_margin: (rate * kPeriod) / 2,
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
        },
        fits: models.map(recordingFitOf),
      },
    ],
    fits,
    comparison: models.length > 1 ? comparisonOf(models[1]) : null,
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
  identifiability: [],
  statistics: null,
};

/** What remains of a fit that failed: a reason. */
export const failed = (fit, reason, more = {}) => ({
  ...fit,
  ...kNothing,
  status: 'failed',
  reason,
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
});

/** What remains of it for a recording. */
export const failedPart = (fit) => ({
  ...fit,
  ...kNothing,
  amplitude_rad: null,
  noise: null,
  constancy: null,
});

/** The result of a fit that failed. */
export function makeFailed() {
  const result = makeResult({ models: ['coulomb'] });
  const reason = 'the pendulum never moves';
  const [recording] = result.recordings;
  Object.assign(recording, {
    sampling: null,
    resolution_rad: null,
    closed_forms: null,
    fits: recording.fits.map((fit) => failedPart(fit)),
  });
  return { ...result, fits: result.fits.map((fit) => failed(fit, reason)), warnings: [] };
}
