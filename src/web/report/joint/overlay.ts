// SPDX-License-Identifier: Apache-2.0
/** Curves of several recordings, or of several fits of one recording, on a common time axis. */

import { recordingMark } from '../../shared/marks';
import { shownFitOf, type OneRecording } from '../report';
import { fittedTrace } from '../sections/fit_section';
import type { Trace } from '../time_plot';

/** One recording: readings, fitted motion and residuals over the time since its beginning, s. */
export interface Overlaid {
  k: number;
  measured: Trace;
  fitted: Trace | null;
  residual: Trace | null;
}

/** Recordings to draw in one plot. */
export interface Overlayable {
  recordings: OneRecording[];
  /** True if all are fits of one recording. Times are then those of its file's clock. */
  oneClock?: boolean;
}

/** What one entry is called: several fits may be of one recording. */
export type OverlaidKind = 'recording' | 'fit';

/** Time zero of a recording, s on its file's clock: its release, or its first used sample. */
export function beginning(one: OneRecording): { time: number; released: boolean } {
  const release = shownFitOf(one)?.parameters.release_time?.estimate;
  if (typeof release === 'number') return { time: release, released: true };
  return { time: one.data.window_s[0], released: false };
}

/** Label of the common time axis. */
export function originWords(recordings: OneRecording[]): string {
  const released = recordings.filter((one) => beginning(one).released).length;
  if (released === recordings.length) return 'time since the release [s]';
  return released === 0
    ? 'time since the first used sample [s]'
    : 'time since release or first used sample [s]';
}

/** Converts times on the file's clock to true seconds since the beginning. */
export function elapsed(time: Float64Array, one: OneRecording): Float64Array {
  const scale = one.data.clock_scale || 1;
  const { time: start } = beginning(one);
  return time.map((t) => (t - start) * scale);
}

/** Null if the series is not part of the report. */
function overlaid(one: OneRecording, k: number, name: string, since: typeof elapsed): Overlaid | null {
  const { samples } = one;
  if (!samples) return null;
  const fit = shownFitOf(one);
  const time = since(samples.time, one);
  const mark = recordingMark(k);
  const fitted = fit && fittedTrace(one, samples, fit, one.report.shown);
  const residual = fit && samples.models.get(fit.model)?.residual;
  const own = { name, shown: true };
  const points = { ...mark, points: true };
  return {
    k,
    measured: { ...own, time, values: samples.measured, mark: points },
    fitted: fitted && { ...own, time: fitted.time === samples.time ? time : since(fitted.time, one), values: fitted.values, mark },
    residual: residual ? { ...own, time, values: residual, mark: points } : null,
  };
}

/**
 * Curves of the recordings whose readings have the same unit as the first. `others`: numbers (from 1) of the recordings
 * that are left out.
 */
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
