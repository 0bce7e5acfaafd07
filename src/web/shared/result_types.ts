// SPDX-License-Identifier: Apache-2.0
/**
 * What the page reads of the result JSON of fit_pendulum, schema_version 3 (result.schema.json). SI units; a missing
 * number is null.
 */

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
  /** Value ± total error; null without a value. */
  text: string | null;
  /** The same of an angle or a rate, in degrees. */
  text_in_degrees?: string;
  fixed: boolean;
  at_bound: boolean;
  reason?: string;
}

export interface Derived {
  estimate: Num;
}

export interface NamedMatrix {
  names: string[];
  matrix: Num[][];
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

export interface Constancy {
  amplitude: { windows: AmplitudeWindow[]; trends: { parameter: string; unit: string }[] } | null;
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
  /** What took the energy, with shares; empty for a law with one loss, missing in results of former versions. */
  losses?: string;
  equation: string;
  units: string;
  textbook: string;
  /** What a value ± error does not say of the parameters; may be empty. */
  remarks: string;
  /** What would make the largest error smaller; results of former versions have none. */
  advice?: string;
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
  identifiability: { parameter: string; verdict: string }[];
}

/** A law: what all recordings share. */
export interface Fit extends Estimates {
  model: string;
  status: Status;
  reason: string;
  /** Names of the parameters that all recordings share: of one recording inertia and friction. */
  shared: string[];
  derived: Record<string, Derived>;
  /** Over all recordings. */
  statistics: Loose | null;
  /** Null for one recording. */
  homogeneity: Homogeneity | null;
  /** Missing in results of earlier versions. */
  summary?: FitSummary;
}

/** The part of a law that belongs to one recording. Its matrices have the shared parameters, too. */
export interface RecordingFit extends Estimates {
  model: string;
  noise: Loose | null;
  constancy: Constancy | null;
}

export interface Comparison {
  recommended: string | null;
  reason: string;
}

export interface Sampling {
  rate_hz: number;
  frequency_hz: Num;
  samples_per_period: Num;
  nyquist_margin: Num;
}

export interface Recording extends Loose {
  path: string | null;
  sha256: string | null;
  samples: number;
  used_samples: number;
  duration_s: number;
  sample_rate_hz: number;
  clock_scale: number;
  window_s: [number, number];
  releases: [number, number][];
  release: number | null;
  sampling: Sampling | null;
  calibration: Loose | null;
  closed_forms: ClosedForms | null;
  /** In the order of the laws of the result. */
  fits: RecordingFit[];
}

export interface ClosedForms {
  linear: (Record<string, Derived> & { periods: never }) | null;
  decrement: { parameters: Record<string, Derived> } | null;
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
