// SPDX-License-Identifier: Apache-2.0
/** JSON of the service's answers. The result of a fit is in shared/result_types.ts. */

import type { Loose, Num, Status } from '../shared/result_types';

export interface ItemParameter {
  estimate: Num;
  unit: string;
  /** Value ± total error; null without a value. */
  text: string | null;
}

export interface ItemModel {
  model: string;
  status: Status;
  reason: string;
  rms_residual: Num;
  residual_unit: string;
  parameters: Record<string, ItemParameter>;
}

/** A fit in the list of fits. */
export interface FitItem {
  id: string;
  /** Given by the user, or that of the file. */
  name: string;
  file?: string;
  created: string;
  batch: string | null;
  state: 'done' | 'waiting';
  exit_code: number | null;
  reason: string;
  /** Begin and end of the fitted samples, s. */
  window_s?: [number, number] | null;
  recommended: string | null;
  models: ItemModel[];
}

export interface FitList {
  fits: FitItem[];
  /** Cursor of the next page. */
  next: string | number | null;
}

export type Flags = Record<string, string>;

export interface FitRequest {
  id: string;
  name: string;
  file: string;
  created: string;
  batch: string | null;
  options: Flags;
  rig: Loose | null;
  calibration: Loose | null;
  data_sha256: string;
}

/** The whole recording, reduced to at most 4000 samples. */
export interface WholeRecording {
  time_s: number[];
  measured: Num[];
  unit: string;
  samples: number;
}

/** A column that the reader chose; the unit is null if it is unknown. */
export interface PreviewColumn {
  column: number;
  unit: string | null;
}

/** Something that a fit needs and that neither the file nor the request says. */
export interface Question {
  options: string[];
  question: string;
  values: string[];
  try: Flags;
}

/** How a recording is read: the answer of POST /v1/previews. */
export interface Preview {
  name: string;
  format: string | null;
  member: string | null;
  columns: { name: string; value_column: string }[];
  rows: string[][];
  time: PreviewColumn | null;
  value: PreviewColumn | null;
  calibration: Loose | null;
  assumptions: { code: string; message: string; options: string[] }[];
  missing: Question[];
  problem: { title: string; status: number; detail: string; code: string } | null;
  samples: WholeRecording | null;
  window: { window_s: [number, number]; begins: string | null; ends: string | null; release: number; releases: [number, number][] } | null;
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

/** Whether the recordings of a batch agree, and their means. */
export interface BatchAgreement {
  law: string | null;
  level: 'good' | 'caution';
  text: string;
  means: { name: string; unit: string; text: string; recordings: number }[];
  outliers: { id: string; parameter: string }[];
}

/** A finished run of a batch. */
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
  gravity: string;
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
  coefficients: { name: string; text: string; unit: string }[];
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
