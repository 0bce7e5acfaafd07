// SPDX-License-Identifier: Apache-2.0
/** Whether several recordings agree: part of the result JSON of fit_pendulum. */

import type { Num } from './result_types';

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
