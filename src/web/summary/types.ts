// SPDX-License-Identifier: Apache-2.0
/** The summary of a batch of refitted runs, schema_version 2 (summary.schema.json). A missing number is null. */

import type { Num, Warning } from '../shared/result_types';

export interface Summary {
  schema_version: number;
  tool: { name: string; version: string };
  headline: RunCounts;
  grouping: Grouping;
  /** The law of the conclusions: the one most often recommended for the recordings that have repeats. */
  main_model: string | null;
  verdicts: ModelVerdict[];
  agreement: Agreement | null;
  /** The recordings that disagree with their repeats, in a sentence. */
  disagreement?: string | null;
  refit?: Refit;
  /** Those that need a look first; at most 500. */
  runs?: ListedRun[];
  store: Store;
  /** What tells the pendulums apart, such as a column of the manifest; null: all runs are of one. */
  group_by: string | null;
  /** Column of the manifest over which trends are fitted; null for the position of the run. */
  trend_by: string | null;
  models: ModelCounts[];
  /** model null: no model was recommended. */
  recommendations: { model: string | null; runs: number }[];
  failures: Failure[];
  parameters: ParameterSummary[];
  warnings: Pick<Warning, 'code' | 'message'>[];
}

/** How many recordings were fitted. text: "198 of 200 recordings fitted; 1 missing, 1 refused". */
export interface RunCounts {
  text: string;
  runs: number;
  fitted: number;
  not_converged: number;
  missing: number;
  refused: number;
  pending: number;
  stale: number;
  unlisted: number;
  missing_runs: { id: string; reason: string }[];
  refused_runs: { id: string; reason: string }[];
  stale_runs: { id: string; reason: string }[];
}

/** Which runs are taken for repeats of one pendulum. text: why; otherwise: how to say otherwise. */
export interface Grouping {
  by: 'column' | 'true_values' | 'rig' | 'folder' | 'all';
  name: string | null;
  is_stated: boolean;
  pendulums: number;
  smallest: number;
  largest: number;
  unlike: number;
  is_compared: boolean;
  text: string;
  otherwise: string | null;
}

/** Whether the errors of a model agree with the scatter between recordings. */
export interface ModelVerdict {
  model: string;
  verdict: 'not_compared' | 'too_small' | 'too_large' | 'few' | 'agrees';
  level: 'good' | 'caution' | 'bad';
  text: string;
}

/** The test of a joint fit, pendulum by pendulum, with the recordings that disagree. */
export interface Agreement {
  model: string;
  groups: number;
  disagreeing: number;
  rows: AgreementRow[];
}

export interface AgreementRow {
  group: string | null;
  runs: number;
  statistic: Num;
  dof: number;
  p: Num;
  outliers: { id: string; parameter: string; estimate: Num; others: Num; z: Num }[];
}

/** The last refit; times are instants, null: not known. text: what is new, in a sentence. */
export interface Refit {
  began: string | null;
  ended: string | null;
  new: number;
  again: number;
  text: string | null;
}

export interface ListedRun {
  id: string;
  level: 'good' | 'caution' | 'bad' | 'waiting';
  /** "fitted", "refused", ... */
  state: string;
  text: string | null;
  model: string | null;
  fitted: string | null;
  /** What the last refit did to it. */
  news: 'new' | 'again' | null;
  /** Writes its report; null: not known. */
  command: string | null;
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
  derived: boolean;
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
  /** Median of the errors that repeats are compared with. */
  median_repeat_error: Num;
  /** The numbers above as they are shown, without their unit; "-": there is none. */
  texts: Record<DistributionNumber, string>;
  histogram: Counts | null;
  repeatability: Repeatability | null;
  repeatability_reason: string | null;
  outliers: Outlier[];
  outliers_total: number;
  trend: Trend | null;
}

type DistributionNumber =
  | 'median'
  | 'mean'
  | 'std_dev'
  | 'minimum'
  | 'maximum'
  | 'lower_quartile'
  | 'upper_quartile'
  | 'median_std_error'
  | 'median_repeat_error';

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
  has_enough_runs: boolean;
  text: string;
  texts: { chi2: string; scatter_ratio: string; p: string; between_std_dev: string };
  rows: GroupRow[];
}

export interface GroupRow {
  group: string;
  runs: number;
  weighted_mean: Num;
  std_error: Num;
  /** Of the mean. */
  interval95: [number, number];
  scatter_ratio: Num;
  scatter_interval95: [number, number];
  p: Num;
  disagrees: boolean;
  /** weighted_mean: with its error. */
  texts: { weighted_mean: string; scatter_ratio: string; scatter_interval95: string; p: string };
}

export interface Outlier {
  id: string;
  group: string | null;
  estimate: Num;
  /** Value ± standard error. */
  text: string;
  z: Num;
  z_text?: string;
}

export interface Trend {
  column: string;
  unit: string | null;
  slope: Num;
  std_error: Num;
  p: Num;
  text: string;
  /** It is not by chance. */
  is_moving?: boolean;
  /** slope: with its error and unit. */
  texts: { slope: string; p: string };
  points: TrendRun[];
  points_total: number;
}

export interface TrendRun {
  x: number;
  y: Num;
  std_error: Num;
  /** Value ± standard error. */
  text: string;
  id: string;
  group: string | null;
}
