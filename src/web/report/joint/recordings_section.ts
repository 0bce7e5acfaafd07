// SPDX-License-Identifier: Apache-2.0
/** Tables of the recordings of a joint fit and of their own parameters. */

import { el, text } from '../../shared/dom';
import { recordingMark, swatch } from '../../shared/marks';
import { typeset } from '../../shared/prose';
import type { Data, Loose } from '../../shared/result_types';
import { intervalText, significant } from '../../shared/rounding';
import { section } from '../../shared/section';
import { table, type Cell, type Column } from '../../shared/table';
import { inDegrees, spacedUnit, withUnit } from '../../shared/units';
import { noteOf, quantityName, valueCell } from '../parameters';
import { ownNames, recordingFile, shownJointFit, type JointReport } from './joint';
import type { JointFit, JointRun } from './joint_types';

const number = 'number' as const;

/** "recording 3", with its colour in the plots, and whether it disagrees. */
export function recordingName(k: number, outliers: readonly number[]): Cell {
  const odd = outliers.includes(k + 1) && el('small', { class: 'no' }, 'disagrees');
  return [swatch(recordingMark(k)), String(k + 1), odd];
}

/** "0.0030 rad" for sigma_rad. */
function readingText(object: Loose | null | undefined, name: string): string {
  const found = withUnit(object, name);
  return found ? significant(found.value, 3) + spacedUnit(found.unit) : '–';
}

const startText = ({ start }: Data): string =>
  start === 'release' ? 'held' : start === 'moving' ? 'in motion' : '–';

function amplitudeText(run: JointRun | undefined): string {
  const amplitude = run?.amplitude_rad ?? null;
  const degrees = inDegrees('rad');
  return amplitude === null || !degrees ? '–' : significant(amplitude * degrees.factor, 3) + degrees.unit;
}

function recordingRow({ result }: JointReport, fit: JointFit | null, k: number): Cell[] {
  const data = result.data[k];
  const run = fit?.runs[k];
  return [
    recordingName(k, fit?.homogeneity.outliers ?? []),
    recordingFile(result, k),
    `${data.used_samples} of ${data.samples}`,
    `${significant(data.window_s[0], 4)} to ${significant(data.window_s[1], 4)}`,
    significant(data.sample_rate_hz, 4),
    startText(data),
    amplitudeText(run),
    readingText(run?.noise, 'sigma'),
    readingText(run?.statistics, 'rms_residual'),
    significant(run?.noise?.lag1_correlation, 2),
    typeset((run?.separate ?? '–').replace(/_/g, ' ')),
  ];
}

function recordingTable(report: JointReport, fit: JointFit | null): HTMLElement {
  const columns: Column[] = [
    { head: 'Recording' },
    { head: 'File' },
    { head: 'Samples', kind: number },
    { head: 'Window [s]', kind: number },
    { head: 'Rate [Hz]', kind: number },
    { head: 'Begins' },
    { head: 'Amplitude', kind: number },
    { head: 'Noise σ', kind: number },
    { head: 'rms residual', kind: number },
    { head: 'Lag-1', kind: number },
    { head: 'Separate fit' },
  ];
  return table('Recordings', columns, report.result.data.map((_data, k) => recordingRow(report, fit, k)));
}

function ownCell(run: JointRun, name: string): Cell {
  const parameter = run.parameters?.[name];
  if (!parameter) return '–';
  const { std_error: error, interval95: interval } = parameter;
  const note = noteOf(parameter);
  const value = valueCell(parameter);
  return [
    ...(Array.isArray(value) ? value : [value]),
    interval !== null && el('small', {}, `95 %: ${intervalText(interval, error)}`),
    note !== '' && el('small', { class: 'why' }, typeset(note)),
  ];
}

/** Null if all parameters are shared, or without a fit. */
function ownTable(fit: JointFit): HTMLElement | null {
  const names = ownNames(fit);
  if (names.length === 0) return null;
  const { outliers } = fit.homogeneity;
  const columns: Column[] = [
    { head: 'Recording' },
    ...names.map((name) => ({ head: el('span', {}, ...quantityName(name)), kind: number })),
  ];
  const rows = fit.runs.map((run, k): Cell[] => [
    recordingName(k, outliers),
    ...names.map((name) => ownCell(run, name)),
  ]);
  return table('Own parameters of each recording, from the joint fit', columns, rows);
}

export function recordingsSection(report: JointReport): HTMLElement {
  const fit = shownJointFit(report);
  return section(
    'recordings',
    'The recordings',
    recordingTable(report, fit),
    text('Amplitudes are root mean squares over the motion. Residuals and noise are those of the joint fit.', 'quiet'),
    fit && ownTable(fit),
  );
}
