// SPDX-License-Identifier: Apache-2.0
/** Curves of all recordings of a joint fit on one clock. */

import { fittedTrace } from './fit_section';
import type { JointResult } from './joint_types';
import { recordingMark } from './marks';
import { shownFit, type Report } from './report';
import type { Trace } from './time_plot';

/** One recording: its readings, the fitted motion and their difference, in s since its beginning. */
export interface Overlaid {
  k: number;
  measured: Trace;
  fitted: Trace | null;
  residual: Trace | null;
}

/** Recordings that can lie over each other: each as it is shown, and its data. */
export interface Overlayable {
  recordings: Report[];
  /** All are of one recording, whose own clock then counts for all. */
  oneClock?: boolean;
  result: Pick<JointResult, 'data'>;
}

/** What is counted: several fits may be of one recording. */
export type OverlaidKind = 'recording' | 'fit';

/** The instant a recording counts from, s on its file's clock: its release, or its first used sample. */
export function beginning(report: Report): { time: number; released: boolean } {
  const release = shownFit(report)?.parameters?.release_time?.estimate;
  if (typeof release === 'number') return { time: release, released: true };
  return { time: report.result.data.window_s[0], released: false };
}

/** What the times of all are counted from, in words. */
export function originWords(reports: Report[]): string {
  const released = reports.filter((report) => beginning(report).released).length;
  if (released === reports.length) return 'time since the release [s]';
  return released === 0
    ? 'time since the first used sample [s]'
    : 'time since release or first used sample [s]';
}

/** Times on the file's clock as true seconds since the beginning. */
export function elapsed(time: Float64Array, report: Report): Float64Array {
  const scale = report.result.data.clock_scale || 1;
  const { time: start } = beginning(report);
  return time.map((t) => (t - start) * scale);
}

/** Null without samples. */
function overlaid(report: Report, k: number, name: string, since: typeof elapsed): Overlaid | null {
  const { samples } = report;
  if (!samples) return null;
  const fit = shownFit(report);
  const time = since(samples.time, report);
  const mark = recordingMark(k);
  const fitted = fit && fittedTrace(report, samples, fit, report.shown);
  const residual = fit && samples.models.get(fit.model)?.residual;
  const own = { name, shown: true };
  const points = { ...mark, points: true };
  return {
    k,
    measured: { ...own, time, values: samples.measured, mark: points },
    fitted: fitted && { ...own, time: fitted.time === samples.time ? time : since(fitted.time, report), values: fitted.values, mark },
    residual: residual ? { ...own, time, values: residual, mark: points } : null,
  };
}

/** Recordings whose reading has the unit of the first; `others`: numbers, from 1 on, of those that cannot lie over it. */
export function overlay(report: Overlayable, kind: OverlaidKind = 'recording'): { curves: Overlaid[]; unit: string; others: number[] } {
  const unit = report.recordings.find((one) => one.samples)?.samples?.unit ?? 'rad';
  const curves: Overlaid[] = [];
  const others: number[] = [];
  const since = report.oneClock ? (time: Float64Array): Float64Array => time : elapsed;
  report.recordings.forEach((one, k) => {
    const made = one.samples?.unit === unit ? overlaid(one, k, `${kind} ${k + 1}`, since) : null;
    if (made) curves.push(made);
    else others.push(k + 1);
  });
  return { curves, unit, others };
}
