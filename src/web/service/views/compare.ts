// SPDX-License-Identifier: Apache-2.0
/** Comparison of fits: their common parameters, and the differences in standard errors. */

import { bestFit, shownFit, type Report } from '../../report/report';
import type { ForestRow } from '../../shared/forest';
import { recordingMark } from '../../shared/marks';
import { elided } from '../../shared/names';
import type { Fit, Parameter, Recording } from '../../shared/result_types';

/** A fit of one recording to compare, with the model that is shown. */
export interface Compared {
  id: string;
  name: string;
  created: string;
  report: Report;
}

/** Stands for the best model of each fit; a name stands for the model of this name. */
export const kBest = '';
const kLabel = 16; // characters of a name in a plot, at most

export const fitOf = ({ report }: Compared): Fit | null => shownFit(report);

export const recordingOf = ({ report }: Compared): Recording => report.result.recordings[0];

/** Models that all fits have, in the order of the first fit. */
export function commonModels(all: readonly Compared[]): string[] {
  const of = ({ report }: Compared): string[] => report.result.fits.map((fit) => fit.model);
  const [first, ...others] = all.map(of);
  return (first ?? []).filter((model) => others.every((models) => models.includes(model)));
}

/** Selects the model of this name in each fit, or the best one. */
export function showModel(all: readonly Compared[], model: string): void {
  for (const { report } of all) {
    const found = report.result.fits.findIndex((fit) => fit.model === model);
    report.shown = model === kBest || found < 0 ? bestFit(report.result) : found;
  }
}

/** Names of all parameters of the selected models, in order of their first occurrence. */
export const parameterNames = (all: readonly Compared[]): string[] => [
  ...new Set(all.flatMap((one) => Object.keys(fitOf(one)?.parameters ?? {}))),
];

export const parameterOf = (one: Compared, name: string): Parameter | null => fitOf(one)?.parameters[name] ?? null;

/** Whether this is a parameter of the pendulum; all others are of the start and of the sensor. */
export const isShared = (all: readonly Compared[], name: string): boolean =>
  all.some((one) => fitOf(one)?.shared.includes(name));

/**
 * (b - a) over its standard error, for independent recordings. Null if the units differ, a value is missing or neither
 * has an error.
 */
export function differenceInErrors(a: Parameter | null, b: Parameter | null): number | null {
  if (!a || !b || a.unit !== b.unit || a.estimate === null || b.estimate === null) return null;
  const error = Math.hypot(a.std_error ?? 0, b.std_error ?? 0);
  return error > 0 ? (b.estimate - a.estimate) / error : null;
}

/** Whether two fits are of the same bytes. */
export function shareRecording(all: readonly Compared[]): boolean {
  const hashes = all.map((one) => recordingOf(one).sha256);
  return hashes.some((hash, i) => hash !== null && hashes.indexOf(hash) !== i);
}

/** Whether all fits are of the same bytes, with the same times. */
export function areOneRecording(all: readonly Compared[]): boolean {
  const [first, ...others] = all.map(recordingOf);
  const isAnother = (rate: number): boolean => Math.abs(rate / first.sample_rate_hz - 1) > 0.01; // parts differ by jitter
  return (
    first.sha256 !== null &&
    others.every(({ sha256, clock_scale }) => sha256 === first.sha256 && clock_scale === first.clock_scale) &&
    !others.some((other) => isAnother(other.sample_rate_hz))
  );
}

/** "1 coulomb.csv" */
export const labelOf = (one: Compared, k: number): string => `${k + 1} ${elided(one.name, kLabel)}`;

/** Rows of the plot of a parameter; empty if fewer than two fits have the same unit. */
export function comparedRows(all: readonly Compared[], name: string): ForestRow[] {
  const unit = all.map((one) => parameterOf(one, name)?.unit).find((found) => found !== undefined);
  const rows = all.flatMap((one, k): ForestRow[] => {
    const parameter = parameterOf(one, name);
    if (!parameter || parameter.unit !== unit || parameter.estimate === null) return [];
    const { estimate, text, interval95 } = parameter;
    const { colour } = recordingMark(k);
    return [
      { kind: 'recording', label: labelOf(one, k), disagrees: false, estimate, text, interval95, colour },
    ];
  });
  return rows.length > 1 ? rows : [];
}

/** Range of an axis that holds all intervals completely. */
export function wholeRange(rows: readonly ForestRow[]): [number, number] {
  const ends = rows.flatMap(({ estimate, interval95 }) => [estimate, ...(interval95 ?? [])]).filter((x) => x !== null);
  const [low, high] = [Math.min(...ends), Math.max(...ends)];
  const margin = 0.05 * (high - low || Math.abs(low) || 1);
  return [low - margin, high + margin];
}
