// SPDX-License-Identifier: Apache-2.0
/** The summary of a batch of refitted runs, schema_version 2 (summary.schema.json). A missing number is null. */

import type { Num, Result } from '../shared/result_types';

export interface Summary {
  schema_version: number;
  tool: { name: string; version: string };
  store: Store;
  /** Column of the manifest: runs with the same value are of one rig. */
  group_by: string | null;
  /** Column of the manifest over which trends are fitted; null for the position of the run. */
  trend_by: string | null;
  models: ModelCounts[];
  /** model null: no model was recommended. */
  recommendations: { model: string | null; runs: number }[];
  failures: Failure[];
  parameters: ParameterSummary[];
  warnings: Result['warnings'];
}

export interface Store {
  path: string;
  runs: number;
  refitted: number;
  pending: number;
  fits: number;
  versions: string[];
  cpus: string[];
  manifest_sha256: string | null;
}

export interface ModelCounts {
  model: string;
  fits: number;
  converged: number;
  not_converged: number;
  not_identifiable: number;
  failed: number;
}

/** Fits that ended for the same reason. examples: ids of some of these runs. */
export interface Failure {
  status: string;
  exit_code: Num;
  reason: string;
  fits: number;
  models: string[];
  examples: string[];
}

/** One parameter of one model over all runs, in `unit`. */
export interface ParameterSummary {
  model: string;
  name: string;
  unit: string;
  runs: number;
  median: Num;
  mean: Num;
  std_dev: Num;
  minimum: Num;
  maximum: Num;
  lower_quartile: Num;
  upper_quartile: Num;
  /** Median of the standard errors of the runs. */
  median_std_error: Num;
  histogram: Counts | null;
  repeatability: Repeatability | null;
  repeatability_reason: string | null;
  outliers: Outlier[];
  outliers_total: number;
  trend: Trend | null;
}

/** Bars of equal width. below, above: number of runs outside the bars. */
export interface Counts {
  from: number;
  to: number;
  counts: number[];
  below: number;
  above: number;
}

export type Verdict = 'agrees' | 'scatter_larger' | 'scatter_smaller';

/** Scatter of the runs of one rig compared with their errors. scatter_ratio: √(chi2 / dof). */
export interface Repeatability {
  groups: number;
  runs: number;
  dof: number;
  chi2: Num;
  scatter_ratio: Num;
  p: Num;
  /** Standard deviation between runs in addition to their errors. */
  between_std_dev: Num;
  verdict: Verdict;
  text: string;
  rows: GroupRow[];
}

export interface GroupRow {
  group: string;
  runs: number;
  weighted_mean: Num;
  std_error: Num;
  scatter_ratio: Num;
  p: Num;
}

export interface Outlier {
  id: string;
  group: string | null;
  estimate: Num;
  std_error: Num;
  z: Num;
}

export interface Trend {
  column: string;
  unit: string | null;
  slope: Num;
  std_error: Num;
  p: Num;
  text: string;
  points: TrendRun[];
  points_total: number;
}

export interface TrendRun {
  x: number;
  y: Num;
  std_error: Num;
  id: string;
  group: string | null;
}
