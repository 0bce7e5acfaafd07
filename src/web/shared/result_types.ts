// SPDX-License-Identifier: Apache-2.0
/** The result JSON of fit_pendulum, schema_version 2 (result.schema.json). SI units; a missing number is null. */

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
  durbin_watson: Num;
  ljung_box_p: Num;
  runs_p: Num;
  effective_samples: Num;
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

export interface Fit {
  model: string;
  status: Status;
  equation?: string | null;
  reason: string;
  /** Missing in results of earlier versions. */
  summary?: FitSummary;
  parameters: Record<string, Parameter>;
  derived: Record<string, Derived>;
  covariance: NamedMatrix;
  correlation: NamedMatrix;
  systematic_covariance: NamedMatrix;
  noise: Noise | null;
  std_error_method: string | null;
  interval_method: string | null;
  identifiability: { parameter: string; verdict: string; direction: string[]; advice: string | null }[];
  statistics: Statistics | null;
  closed_form: ClosedFormRow[];
  solver: { iterations: number; evaluations: number; termination: string };
  constancy?: Constancy | null;
  constancy_reason?: string;
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

export interface Data extends Loose {
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
}

export interface ClosedForms extends Loose {
  model: string;
  linear: (Record<string, Derived> & { periods: never }) | null;
  decrement: { parameters: Record<string, Derived>; chi_square: Num; dof: number; p: Num } | null;
  envelopes: { term: string; shape: string; chi_square: Num; dof: number; p: Num }[];
  envelope: string | null;
  turning_points: number;
}

/** All but code and message are absent in results of older versions. */
export interface Warning {
  code: string;
  message: string;
  /** The message without the law. */
  text?: string;
  law?: string | null;
  /** Of a joint fit, from 1; empty: it is about the whole. */
  recordings?: number[];
}

export interface Result {
  schema_version: number;
  tool: { name: string; version: string };
  data: Data;
  rig: Record<string, number | { value: number; std_dev?: number }> | null;
  calibration: Loose | null;
  fits: Fit[];
  closed_forms: ClosedForms | null;
  comparison?: Comparison | null;
  warnings: Warning[];
  reason?: string;
}

/** Only in the HTML page. */
export interface Command {
  command: string;
}
