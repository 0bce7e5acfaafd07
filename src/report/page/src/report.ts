// SPDX-License-Identifier: Apache-2.0
/** What every section is made from. */

import { toSamples, type Samples } from './samples';
import type { Command, ComparisonRow, Fit, Result, Series } from './types';

export interface Report {
  result: Result;
  series: Series | null;
  samples: Samples | null;
  command: Command | null;
  /** Index of the fit that is shown in detail; -1: there is none. */
  shown: number;
  /** Range of times that was last looked at, s; kept when another model is shown. */
  range?: [number, number];
}

/** The recommended fit, else the first that converged, else the first; -1 of none. */
export function bestFit(result: Result): number {
  const recommended = result.fits.findIndex((fit) => fit.model === result.comparison?.recommended);
  if (recommended >= 0) return recommended;
  const converged = result.fits.findIndex((fit) => fit.status === 'converged');
  return converged >= 0 ? converged : result.fits.length > 0 ? 0 : -1;
}

export function makeReport(result: Result, series: Series | null, command: Command | null): Report {
  return { result, series, samples: toSamples(series), command, shown: bestFit(result) };
}

/** 0 of the best fit, then the others in their order: what they are coloured by. */
export function rankOf(result: Result, index: number): number {
  const best = bestFit(result);
  return index === best ? 0 : index < best ? index + 1 : index;
}

export const shownFit = (report: Report): Fit | null => report.result.fits[report.shown] ?? null;

export function comparisonRow(result: Result, model: string): ComparisonRow | null {
  return result.comparison?.rows.find((row) => row.model === model) ?? null;
}

export const hasWarning = (result: Result, code: string): boolean =>
  result.warnings.some((warning) => warning.code === code);

/** True when the fit says that more than noise is left; of several fits without a comparison none can be named. */
export function lacksFit(result: Result, fit: Fit): boolean {
  const row = comparisonRow(result, fit.model);
  return row ? row.lack_of_fit : result.fits.length === 1 && hasWarning(result, 'lack_of_fit');
}

/** The file's name without its folders. */
export const fileName = (path: string | null): string => path?.split(/[\\/]/).pop() || 'recording without a name';
