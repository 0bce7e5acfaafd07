// SPDX-License-Identifier: Apache-2.0
/** A joint fit seen as what the sections of one recording know: as a whole, and by one recording after another. */

import type { JointFit, JointResult } from './joint_types';
import { fileName, makeReport, type Report } from './report';
import type { Command, Fit, Result, Series } from './types';

/** What every section of a joint fit is made from. */
export interface JointReport {
  result: JointResult;
  /** The shared parameters, as if they were of one recording. */
  whole: Report;
  /** Each recording by itself, its parameters by the joint fit. */
  recordings: Report[];
  /** Index of the recording that is shown in detail. */
  recording: number;
}

export const isJoint = (result: Result | JointResult): result is JointResult => Array.isArray(result.data);

/** The message of a warning of recording k (from 0 on), or of each, begins with whose it is, as fit_pendulum writes it. */
const isOf = (message: string, k: number): boolean => new RegExp(`^(recording ${k + 1}\\b|each recording:)`).test(message);

/** Recording k of the joint fit as a result of one recording. */
export function recordingView(result: JointResult, k: number): Result {
  return {
    ...result,
    data: result.data[k],
    calibration: result.calibration[k] ?? null,
    closed_forms: result.closed_forms[k] ?? null,
    fits: result.fits.map((fit): Fit => ({ ...fit, ...fit.runs[k] })),
    warnings: result.warnings.filter(({ message }) => isOf(message, k)),
  };
}

const wholeFit = (fit: JointFit): Fit => ({ ...fit, noise: null, statistics: null, closed_form: [] });

/** What all recordings say together: the shared parameters, the comparison and all warnings. */
export function wholeView(result: JointResult): Result {
  return { ...result, data: result.data[0], calibration: null, closed_forms: null, fits: result.fits.map(wholeFit) };
}

/** `series`: one for each recording, or null. */
export function makeJointReport(result: JointResult, series: Series[] | null, command: Command | null): JointReport {
  return {
    result,
    whole: makeReport(wholeView(result), series?.[0] ?? null, command),
    recordings: result.data.map((_data, k) => makeReport(recordingView(result, k), series?.[k] ?? null, command)),
    recording: 0,
  };
}

export const shownJointFit = ({ result, whole }: JointReport): JointFit | null => result.fits[whole.shown] ?? null;

/** Shows another model, in all of its views. */
export function showModel(report: JointReport, index: number): void {
  for (const view of [report.whole, ...report.recordings]) view.shown = index;
}

/** "run1.csv", and which free swing where a file has several recordings. */
export function recordingFile({ data }: JointResult, k: number): string {
  const { path, release } = data[k];
  const again = data.filter((other) => other.path === path).length > 1;
  return fileName(path) + (again && release !== null ? `, free swing ${release}` : '');
}

/** "1, 2 and 3" */
export function inList(items: readonly (string | number)[]): string {
  if (items.length < 2) return items.join('');
  return `${items.slice(0, -1).join(', ')} and ${items[items.length - 1]}`;
}

/** Parameters that each recording has for itself, in the order of the fit. */
export function ownNames({ shared, runs }: JointFit): string[] {
  const names = new Set(runs.flatMap((run) => Object.keys(run.parameters ?? {})));
  return [...names].filter((name) => !shared.includes(name));
}
