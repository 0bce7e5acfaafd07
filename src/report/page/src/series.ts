// SPDX-License-Identifier: Apache-2.0
/** The series JSON of fit_pendulum: N samples and what belongs to them, times in s on the file's clock. */

import type { Loose, Num } from './types';

export interface PeakJson extends Loose {
  number: number;
  time_s: number;
  std_error: Num;
}

export interface ProfileCurve {
  value: number[];
  statistic: number[];
  threshold: number;
}

export interface ModelSeries {
  fitted: Num[] | null;
  residual: Num[] | null;
  linear_closed_form: Num[] | null;
  nonlinear_closed_form: Num[] | null;
}

export interface Series {
  time_s: number[];
  measured: Num[];
  unit: string;
  extrema: [number, number][];
  peaks: PeakJson[];
  profiles: Record<string, Record<string, ProfileCurve>> | null;
  models: Record<string, ModelSeries>;
}
