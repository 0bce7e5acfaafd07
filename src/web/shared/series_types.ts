// SPDX-License-Identifier: Apache-2.0
/**
 * The series JSON of fit_pendulum (report/series.h): N samples and the curves computed from them. Times in s on the
 * file's clock.
 */

import type { Loose, Num } from './result_types';

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
  /** Standard errors of `fitted`. */
  fitted_std_error?: Num[] | null;
  residual: Num[] | null;
  linear_closed_form: Num[] | null;
  nonlinear_closed_form: Num[] | null;
}

/** The fitted motion at equal steps, where the samples do not show it. */
export interface MotionJson {
  /** Time of the first point and step, s on the file's clock. */
  start_s: number;
  interval_s: number;
  angle_unit: string;
  /** From the equilibrium, in angle_unit. */
  angle: Num[];
  /** In angle_unit per true second. */
  rate: Num[];
  /** What the sensor shows, in the unit of the readings. */
  reading: Num[] | null;
}

export interface Series {
  time_s: number[];
  measured: Num[];
  unit: string;
  extrema: [number, number][];
  peaks: PeakJson[];
  profiles: Record<string, Record<string, ProfileCurve>> | null;
  models: Record<string, ModelSeries>;
  /** By model; null where the samples show the motion. */
  motions: Record<string, MotionJson | null> | null;
}
