// SPDX-License-Identifier: Apache-2.0
/**
 * Views of a joint fit that the sections for one recording can show: of the shared parameters, and of each recording.
 */

import { fileName } from '../../shared/names';
import type { Command, Fit, Result, Series } from '../../shared/result_types';
import { makeReport, type Report } from '../report';
import type { JointFit, JointResult } from './joint_types';

/** The input of every section of a joint fit. */
export interface JointReport {
  result: JointResult;
  /** The shared parameters, as the result of one recording. */
  whole: Report;
  /** Each recording, with its parameters from the joint fit. */
  recordings: Report[];
  /** Index of the recording that is shown in detail. */
  recording: number;
}

export const isJoint = (result: Result | JointResult): result is JointResult => Array.isArray(result.data);

/** Recording k of the joint fit as a result of one recording. */
export function recordingView(result: JointResult, k: number): Result {
  return {
    ...result,
    data: result.data[k],
    calibration: result.calibration[k] ?? null,
    closed_forms: result.closed_forms[k] ?? null,
    fits: result.fits.map((fit): Fit => ({ ...fit, ...fit.runs[k] })),
    warnings: result.warnings.filter(({ recordings = [] }) => recordings.includes(k + 1)),
  };
}

const wholeFit = (fit: JointFit): Fit => ({ ...fit, noise: null, statistics: null, closed_form: [] });

/** The joint result: the shared parameters, the comparison and all warnings. */
export function wholeView(result: JointResult): Result {
  return { ...result, data: result.data[0], calibration: null, closed_forms: null, fits: result.fits.map(wholeFit) };
}

/** series: one for each recording, or null. */
export function makeJointReport(result: JointResult, series: Series[] | null, command: Command | null): JointReport {
  return {
    result,
    whole: makeReport(wholeView(result), series?.[0] ?? null, command),
    recordings: result.data.map((_data, k) => makeReport(recordingView(result, k), series?.[k] ?? null, command)),
    recording: 0,
  };
}

export const shownJointFit = ({ result, whole }: JointReport): JointFit | null => result.fits[whole.shown] ?? null;

/** Shows another model in all views. */
export function showModel(report: JointReport, index: number): void {
  for (const view of [report.whole, ...report.recordings]) view.shown = index;
}

/** "run1.csv"; "run1.csv, free swing 2" if several recordings are from this file. */
export function recordingFile({ data }: JointResult, k: number): string {
  const { path, release } = data[k];
  const again = data.filter((other) => other.path === path).length > 1;
  return fileName(path) + (again && release !== null ? `, free swing ${release}` : '');
}

/** Names of the parameters that are not shared, in the order of the fit. */
export function ownNames({ shared, runs }: JointFit): string[] {
  const names = new Set(runs.flatMap((run) => Object.keys(run.parameters ?? {})));
  return [...names].filter((name) => !shared.includes(name));
}
