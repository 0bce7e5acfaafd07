// SPDX-License-Identifier: Apache-2.0
/** The input of every section of a report. */

import type { Command, ComparisonRow, Fit, Result, Series } from '../shared/result_types';
import { toSamples, type Samples } from '../shared/samples';

export interface Report {
  result: Result;
  series: Series | null;
  samples: Samples | null;
  command: Command | null;
  /** Index of the fit that is shown in detail; -1 without a fit. */
  shown: number;
  /** Time range of the plots, s. It stays the same when another model is shown. */
  range?: [number, number];
}

/** Index of the recommended fit, else of the first that converged, else 0; -1 without a fit. */
export function bestFit(result: Result): number {
  const recommended = result.fits.findIndex((fit) => fit.model === result.comparison?.recommended);
  if (recommended >= 0) return recommended;
  const converged = result.fits.findIndex((fit) => fit.status === 'converged');
  return converged >= 0 ? converged : result.fits.length > 0 ? 0 : -1;
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

export function comparisonRow(result: Result, model: string): ComparisonRow | null {
  return result.comparison?.rows.find((row) => row.model === model) ?? null;
}

export const hasWarning = (result: Result, code: string): boolean =>
  result.warnings.some((warning) => warning.code === code);

/**
 * Whether the residuals of this fit are more than noise. Without a comparison the warning does not name one of several
 * fits, so this is false.
 */
export function lacksFit(result: Result, fit: Fit): boolean {
  const row = comparisonRow(result, fit.model);
  return row ? row.lack_of_fit : result.fits.length === 1 && hasWarning(result, 'lack_of_fit');
}
