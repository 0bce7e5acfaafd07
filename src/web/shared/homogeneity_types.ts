// SPDX-License-Identifier: Apache-2.0
/** Whether several recordings agree: part of the result JSON of fit_pendulum. */

import type { Num } from './result_types';

/** Estimate of a shared parameter from one recording alone; null if this recording does not determine it. */
export interface RunEstimate {
  estimate: Num;
  std_error: Num;
  text: string | null;
}

export interface RandomEffects {
  mean: Num;
  text: string;
  interval95: [Num, Num] | null;
}

export interface SharedAgreement {
  unit: string;
  agrees?: boolean; // absent in results of older versions
  random_effects: RandomEffects;
  recordings: RunEstimate[];
}

export interface Homogeneity {
  agrees: boolean | null;
  /** Numbers of recordings, counted from 1. */
  outliers: number[];
  parameters: Record<string, SharedAgreement>;
}
