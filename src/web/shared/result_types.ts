// SPDX-License-Identifier: Apache-2.0
/** The result JSON of fit_pendulum, schema_version 3 (result.schema.json). SI units; a missing number is null. */

import type { Homogeneity } from './homogeneity_types';

export type { Homogeneity, SharedAgreement } from './homogeneity_types';
export type { ModelSeries, MotionJson, PeakJson, ProfileCurve, Series } from './series_types';

export type Num = number | null;

/** Keys that end in the unit of the readings (rms_residual_rad, resolution_counts ...) are looked up by withUnit(). */
export type Loose = Record<string, unknown>;

export interface Parameter {
  estimate: Num;
  std_error: Num;
  interval95: [Num, Num] | null;
  systematic_std_error: Num;
  /** Statistical and systematic error together. */
  total_std_error?: Num;
  /** Standard error by source: noise, rig, calibration, clock, sensor, inconstancy, friction_law. */
  error_budget?: Record<string, Num> | null;
  unit: string;
  fixed: boolean;
  at_bound: boolean;
  reason?: string;
}

export interface Derived {
  estimate: Num;
  std_error: Num;
  interval95?: [Num, Num] | null;
  unit: string;
  systematic_std_error?: number;
  reason?: string;
}

export interface NamedMatrix {
  names: string[];
  matrix: Num[][];
}

export interface ClosedFormRow {
  quantity: string;
  method: string;
  closed_form: Num;
  std_error: Num;
  fit: Num;
  fit_std_error: Num;
  unit: string;
  z: Num;
  agrees: boolean | null;
  reason: string | null;
}

export interface Noise extends Loose {
  model: string;
  reason: string;
  sigma_std_error: Num;
  saturated_samples: number;
  lag1_correlation: Num;
  correlation: string;
}

export interface Statistics extends Loose {
  log_likelihood: Num;
  aic: Num;
  aicc: Num;
  bic: Num;
  effective_samples: Num;
}

export interface RecordingStatistics extends Statistics {
  durbin_watson: Num;
  ljung_box_p: Num;
  runs_p: Num;
}

export interface HalvesRow {
  parameter: string;
  unit: string;
  first: Num;
  first_std_error: Num;
  second: Num;
  second_std_error: Num;
  z: Num;
}

export interface AmplitudeWindow {
  from_s: number;
  to_s: number;
  amplitude_rad: Num;
  inertia: Num;
  inertia_std_error: Num;
  friction: Num;
  friction_std_error: Num;
}

export interface Trend {
  parameter: string;
  unit: string;
  slope: Num;
  slope_std_error: Num;
  /** Relative change during the recording. */
  span: Num;
  p: Num;
}

export interface Constancy {
  verdict: string;
  constant: boolean;
  halves: { statistic: Num; dof: number; p: Num; rows: HalvesRow[] } | null;
  amplitude: { windows: AmplitudeWindow[]; trends: Trend[] } | null;
  reason?: string;
}

/** A quantity as one quotes it: value and total error as texts, rounded together; empty if there is none. */
export interface SummaryQuantity {
  name: string;
  symbol: string;
  value: string;
  error: string;
  unit: string;
  source: string;
}

/** What a reader needs to know of a fit first, in words and rounded numbers. */
export interface FitSummary {
  verdict: string;
  level: 'good' | 'caution' | 'bad';
  /** Whether several recordings agree; empty for one. */
  agreement: string;
  parameters: SummaryQuantity[];
  derived: SummaryQuantity[];
  equation: string;
  units: string;
  textbook: string;
  /** What a value ± error does not say of the parameters; may be empty. */
  remarks: string;
  /** What the numbers rest on that nobody said; missing in results of earlier versions. */
  assumptions?: string[];
  warnings: string[];
}

export type Status = 'converged' | 'not_converged' | 'not_identifiable' | 'failed';

/** Parameters with their errors, and how well the readings determine them. */
interface Estimates {
  parameters: Record<string, Parameter>;
  covariance: NamedMatrix;
  correlation: NamedMatrix;
  systematic_covariance: NamedMatrix;
  std_error_method: string | null;
  identifiability: { parameter: string; verdict: string; direction: string[]; advice: string | null }[];
}

/** A law: what all recordings share. */
export interface Fit extends Estimates {
  model: string;
  status: Status;
  reason: string;
  equation: string | null;
  /** Names of the parameters that all recordings share: of one recording inertia and friction. */
  shared: string[];
  derived: Record<string, Derived>;
  interval_method: string | null;
  /** Over all recordings. */
  statistics: Statistics | null;
  /** Null for one recording. */
  homogeneity: Homogeneity | null;
  solver: { iterations: number; evaluations: number; termination: string };
  /** Missing in results of earlier versions. */
  summary?: FitSummary;
}

/** The part of a law that belongs to one recording. Its matrices have the shared parameters, too. */
export interface RecordingFit extends Estimates {
  model: string;
  /** Root mean square over the fitted motion. */
  amplitude_rad: Num;
  noise: Noise | null;
  statistics: RecordingStatistics | null;
  closed_form: ClosedFormRow[];
  constancy: Constancy | null;
  constancy_reason?: string;
  /** How the fit of this recording alone ended. */
  separate: string;
}

export interface Prediction extends Loose {
  standardized: Num;
  samples: number;
}

export interface ComparisonRow extends Loose {
  model: string;
  is_compared: boolean;
  parameters: number;
  log_likelihood: Num;
  aic: Num;
  aicc: Num;
  bic: Num;
  delta_bic: Num;
  akaike_weight: Num;
  cross_validation: Prediction | null;
  forward_prediction: Prediction | null;
  lag1_correlation: Num;
  ljung_box_p: Num;
  lack_of_fit: boolean;
  reason?: string;
}

export interface RatioTest {
  simpler: string;
  richer: string;
  added: string[];
  statistic: Num;
  null: string | null;
  p: Num;
  reason?: string;
}

export interface Comparison {
  recommended: string | null;
  reason: string;
  criterion: string | null;
  criterion_reason: string;
  likelihood: string;
  effective_samples: Num;
  rows: ComparisonRow[];
  tests: RatioTest[];
}

export interface Sampling {
  rate_hz: number;
  jitter_s: Num;
  gaps: number;
  longest_gap_s: number;
  frequency_hz: Num;
  apparent_frequency_hz: Num;
  expected_frequency_hz: Num;
  samples_per_period: Num;
  nyquist_margin: Num;
  start_counts: Num;
  end_counts: Num;
  saturated_samples: number;
}

export interface Recording extends Loose {
  path: string | null;
  sha256: string | null;
  samples: number;
  used_samples: number;
  duration_s: number;
  sample_rate_hz: number;
  resolution_source: string | null;
  clock_scale: number;
  clock_scale_std_dev: number;
  window_s: [number, number];
  window_reason: string | null;
  releases: [number, number][];
  release: number | null;
  start: 'release' | 'moving' | null;
  sampling: Sampling | null;
  calibration: Loose | null;
  closed_forms: ClosedForms | null;
  /** In the order of the laws of the result. */
  fits: RecordingFit[];
  /** Why closed_forms is null. */
  reason?: string;
}

export interface ClosedForms extends Loose {
  model: string;
  linear: (Record<string, Derived> & { periods: never }) | null;
  decrement: { parameters: Record<string, Derived>; chi_square: Num; dof: number; p: Num } | null;
  envelopes: { term: string; shape: string; chi_square: Num; dof: number; p: Num }[];
  envelope: string | null;
  turning_points: number;
}

export interface Warning {
  code: string;
  message: string;
  /** The message without the law. */
  text: string;
  finding: string;
  explanation: string | null;
  advice: string | null;
  flags: string[];
  /** As an assumption, in short. */
  assumed: string | null;
  law: string | null;
  /** Of several recordings, from 1; empty: it is about the whole. */
  recordings: number[];
  parameters: string[];
}

export interface Result {
  schema_version: number;
  tool: { name: string; version: string };
  rig: Record<string, number | { value: number; std_dev?: number }> | null;
  recordings: Recording[];
  fits: Fit[];
  comparison: Comparison | null;
  warnings: Warning[];
}

/** Only in the HTML page. */
export interface Command {
  command: string;
}
