// SPDX-License-Identifier: Apache-2.0
/** The input of every section of a report. */

import { mainFit } from '../shared/main_fit';
import type { Command, Fit, Result, Series } from '../shared/result_types';
import { medianInterval, toSamples, type Samples } from '../shared/samples';
import { TimeView } from '../shared/time_view';
import { withUnit } from '../shared/units';

export interface Report {
  result: Result;
  series: Series | null;
  samples: Samples | null;
  command: Command | null;
  /** Index of the fit that is shown in detail; -1 without a fit. */
  shown: number;
  /** Time range of the plots. It stays the same when another model is shown. */
  view?: TimeView;
}

/** Index of the main fit; -1 without a fit. */
export function bestFit(result: Result): number {
  const rms = (fit: Fit) => withUnit(fit.statistics, 'rms_residual')?.value;
  const best = mainFit(result.fits, result.comparison?.recommended, rms);
  return best ? result.fits.indexOf(best) : -1;
}

export function makeReport(result: Result, series: Series | null, command: Command | null): Report {
  return { result, series, samples: toSamples(series), command, shown: bestFit(result) };
}

/** Rank of a fit, which determines its colour: 0 for the best fit, then the others in their order. */
export function rankOf(result: Result, index: number): number {
  const best = bestFit(result);
  return index === best ? 0 : index < best ? index + 1 : index;
}

export const shownFit = (report: Report): Fit | null => report.result.fits[report.shown] ?? null;

/** Whether the swing is sampled less than twice a period. */
export function isAliased({ result }: Report): boolean {
  const margin = result.data.sampling?.nyquist_margin;
  return hasWarning(result, 'aliased') || (typeof margin === 'number' && margin < 1);
}

const hasWarning = (result: Result, code: string): boolean =>
  result.warnings.some((warning) => warning.code === code);

/** The time range that the plots of the readings share. */
export function sharedView(report: Report, { time }: Samples): TimeView {
  report.view ??= new TimeView(time[0], time[time.length - 1], 8 * medianInterval(time));
  return report.view;
}

type Warnings = Result['warnings'];

/** Warnings about this law, without its name. */
const warningsWith = (model: string, warnings: Warnings): Warnings =>
  warnings.filter(({ law }) => law === model).map((warning) => ({ ...warning, message: warning.text ?? warning.message }));

/** Warnings about no law in particular, and those about this one. */
export function warningsOf({ warnings }: Pick<Result, 'warnings'>, model: string | null): Warnings {
  const general = warnings.filter(({ law }) => (law ?? null) === null);
  return [...general, ...(model === null ? [] : warningsWith(model, warnings))];
}

/** Warnings of each other model that has any. */
export function otherWarnings(
  { fits, warnings }: Pick<Result, 'fits' | 'warnings'>,
  model: string | null,
): { model: string; warnings: Warnings }[] {
  return fits
    .filter((fit) => fit.model !== model)
    .map((fit) => ({ model: fit.model, warnings: warningsWith(fit.model, warnings) }))
    .filter((other) => other.warnings.length > 0);
}
