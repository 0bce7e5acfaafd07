// SPDX-License-Identifier: Apache-2.0
/** The input of the sections of a report: the result, and each of its recordings. */

import { mainFit } from '../shared/main_fit';
import { fileName } from '../shared/names';
import type { Command, Fit, Recording, RecordingFit, Result, Series } from '../shared/result_types';
import { medianInterval, toSamples, type Samples } from '../shared/samples';
import type { ReportSection } from '../shared/sections';
import { TimeView } from '../shared/time_view';
import { withUnit } from '../shared/units';

/** A law fitted to one recording: all its parameters, the shared ones first. */
export type RecordedFit = Fit & RecordingFit;

/** The input of the sections about one recording. */
export interface OneRecording {
  report: Report;
  /** From 1. */
  number: number;
  data: Recording;
  /** In the order of the laws of the result. */
  fits: RecordedFit[];
  series: Series | null;
  samples: Samples | null;
  /** Time range of the plots. It stays the same when another model is shown. */
  view?: TimeView;
}

export interface Report {
  result: Result;
  recordings: OneRecording[];
  command: Command | null;
  /** Words and tables of all laws and recordings; null if the program did not write them. */
  told: ReportSection[] | null;
  /** Index of the law that is shown in detail; -1 without a fit. */
  shown: number;
  /** Index of the recording that is shown in detail. */
  recording: number;
}

/** Index of the main fit; -1 without a fit. */
export function bestFit(result: Result): number {
  const rms = (fit: Fit) => withUnit(fit.statistics, 'rms_residual');
  const best = mainFit(result.fits, result.comparison?.recommended, rms);
  return best ? result.fits.indexOf(best) : -1;
}

/** What the recordings share, and the recording's own part. */
const recorded = (fit: Fit, own: RecordingFit): RecordedFit => ({
  ...fit,
  ...own,
  parameters: { ...fit.parameters, ...own.parameters },
  identifiability: [...fit.identifiability, ...own.identifiability],
});

/** series: one for each recording, or null. */
export function makeReport(
  result: Result,
  series: Series[] | null,
  command: Command | null,
  told: ReportSection[] | null = null,
): Report {
  const report: Report = { result, recordings: [], command, told, shown: bestFit(result), recording: 0 };
  report.recordings = result.recordings.map((data, k) => {
    const own = series?.[k] ?? null;
    const fits = result.fits.map((fit, i) => recorded(fit, data.fits[i]));
    return { report, number: k + 1, data, fits, series: own, samples: toSamples(own) };
  });
  return report;
}

/** Rank of a fit, which determines its colour: 0 for the best fit, then the others in their order. */
export function rankOf(result: Result, index: number): number {
  const best = bestFit(result);
  return index === best ? 0 : index < best ? index + 1 : index;
}

export const isSeveral = ({ recordings }: Report): boolean => recordings.length > 1;

/** The fit that is shown: of one recording with all parameters, of several with those that they share. */
export const shownFit = (report: Report): Fit | null =>
  (isSeveral(report) ? report.result : report.recordings[0]).fits[report.shown] ?? null;

/** The fit that is shown, with all parameters of this recording. */
export const shownFitOf = ({ report, fits }: OneRecording): RecordedFit | null => fits[report.shown] ?? null;

/** "run1.csv"; "run1.csv, free swing 2" if several recordings are from this file. */
export function recordingFile({ report, data: { path, release } }: OneRecording): string {
  const again = report.recordings.filter(({ data }) => data.path === path).length > 1;
  return fileName(path) + (again && release !== null ? `, free swing ${release}` : '');
}

/** Whether the swing is sampled less than twice a period. */
export function isAliased({ report, number, data }: OneRecording): boolean {
  const margin = data.sampling?.nyquist_margin;
  return (
    report.result.warnings.some(
      ({ code, recordings: about }) => code === 'aliased' && (about.length === 0 || about.includes(number)),
    ) ||
    (typeof margin === 'number' && margin < 1)
  );
}

/** The time range that the plots of the readings share. */
export function sharedView(one: OneRecording, { time }: Samples): TimeView {
  one.view ??= new TimeView(time[0], time[time.length - 1], 8 * medianInterval(time));
  return one.view;
}

type Warnings = Result['warnings'];

/** Warnings about this law, without its name. */
const warningsWith = (model: string, warnings: Warnings): Warnings =>
  warnings.filter(({ law }) => law === model).map((warning) => ({ ...warning, message: warning.text }));

/** Warnings about no law in particular, and those about this one. */
export const warningsOf = ({ warnings }: Pick<Result, 'warnings'>, model: string): Warnings => [
  ...warnings.filter(({ law }) => law === null),
  ...warningsWith(model, warnings),
];
