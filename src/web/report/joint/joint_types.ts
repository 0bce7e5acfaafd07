// SPDX-License-Identifier: Apache-2.0
/** The result JSON of a joint fit. data, calibration and closed_forms are lists with one entry for each recording. */

import type { ClosedForms, Data, Fit, Loose, Num, Result } from '../../shared/result_types';

/** Estimate of a shared parameter from one recording alone; null if this recording does not determine it. */
export interface RunEstimate {
  estimate: Num;
  std_error: Num;
  z: Num;
}

export interface RandomEffects {
  mean: Num;
  std_error: Num;
  interval95: [Num, Num] | null;
  between_std_dev: Num;
  between_interval95: [Num, Num] | null;
}

export interface SharedAgreement {
  unit: string;
  statistic: Num;
  dof: number;
  p: Num;
  mean: Num;
  std_error: Num;
  random_effects: RandomEffects;
  runs: RunEstimate[];
}

export interface AmplitudeDependence {
  parameter: string;
  slope: Num;
  std_error: Num;
  unit: string;
  p: Num;
  /** Relative change from the smallest swings to the largest. */
  span: Num;
  p_of_remainder: Num;
}

export interface Homogeneity {
  statistic: Num;
  dof: number;
  p: Num;
  agrees: boolean | null;
  /** Numbers of recordings, counted from 1. */
  outliers: number[];
  verdict: string;
  parameters: Record<string, SharedAgreement>;
  amplitude_dependence: AmplitudeDependence[];
  reason?: string;
}

type OfOneRecording = 'noise' | 'statistics' | 'closed_form' | 'constancy' | 'constancy_reason';
type Both = 'parameters' | 'covariance' | 'correlation' | 'systematic_covariance' | 'std_error_method' | 'identifiability';

/** One recording in the joint fit: all parameters of its motion, including the shared ones. */
export interface JointRun extends Pick<Fit, OfOneRecording | Both> {
  path: string | null;
  release: number | null;
  /** Root mean square over the motion, rad. */
  amplitude_rad: Num;
  /** How the separate fit of this recording ended. */
  separate: string;
}

export interface JointFit extends Omit<Fit, OfOneRecording> {
  shared: string[];
  statistics: Loose | null;
  homogeneity: Homogeneity;
  runs: JointRun[];
}

export interface JointResult extends Omit<Result, 'data' | 'calibration' | 'closed_forms' | 'fits'> {
  data: Data[];
  calibration: (Loose | null)[];
  closed_forms: (ClosedForms | null)[];
  fits: JointFit[];
}
