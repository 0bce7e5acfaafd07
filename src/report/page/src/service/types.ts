// SPDX-License-Identifier: Apache-2.0
/** What the service answers; the result of a fit is that of ../types. */

import type { Loose, Num, Status } from '../types';

export interface ItemParameter {
  estimate: Num;
  std_error: Num;
  unit: string;
}

export interface ItemModel {
  model: string;
  status: Status;
  reason: string;
  rms_residual: Num;
  residual_unit: string;
  parameters: Record<string, ItemParameter>;
}

/** A fit in the list of past ones. */
export interface FitItem {
  id: string;
  name: string;
  created: string;
  batch: string | null;
  state: 'done' | 'waiting';
  exit_code: number | null;
  reason: string;
  recommended: string | null;
  models: ItemModel[];
}

export interface FitList {
  fits: FitItem[];
  /** Where the next page begins. */
  next: string | number | null;
}

export type Flags = Record<string, string>;

export interface FitRequest {
  id: string;
  name: string;
  created: string;
  batch: string | null;
  options: Flags;
  rig: Loose | null;
  calibration: Loose | null;
  data_sha256: string;
}

/** The whole recording, thinned. */
export interface WholeRecording {
  time_s: number[];
  measured: Num[];
  unit: string;
  samples: number;
}

export interface BatchRun {
  id: string;
  name: string;
  state: 'done' | 'waiting';
  exit_code: number | null;
  reason: string;
}

export interface Batch {
  id: string;
  created: string;
  state: 'running' | 'done';
  runs: number;
  done: number;
  failed: number;
  fits: BatchRun[];
}

/** One run of a batch that is done. */
export interface BatchProgress {
  id: string;
  name: string;
  exit_code: number | null;
  reason: string;
  done: number;
  failed: number;
  runs: number;
}

export interface ModelInfo {
  name: string;
  label: string;
  about: string;
  equation: string;
}

export interface Example {
  name: string;
  title: string;
  about: string;
  models: string | string[];
  has_rig: boolean;
}

export interface ExampleData extends Omit<Example, 'has_rig'> {
  recording: string;
  rig: Loose | null;
}

export interface CalibrationPoint {
  reading: number;
  angle: number;
  fitted: number;
  residual: number;
  left_out: Num;
}

export interface CalibrationAnswer {
  calibration: Loose & { coefficients: number[]; input: string; angle_unit: string; residual_std_dev: Num };
  order: number;
  points: CalibrationPoint[];
  leave_one_out_rms: Num;
  text: string;
}

export interface LiveState {
  state: 'waiting' | 'recording' | 'ended';
  name: string;
  samples: number;
  unit: string;
  rate_hz: Num;
}
