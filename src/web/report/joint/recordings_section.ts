// SPDX-License-Identifier: Apache-2.0
/** Tables of the recordings of a joint fit and of their own parameters. */

import { el, text } from '../../shared/dom';
import { recordingMark, swatch } from '../../shared/marks';
import { typeset } from '../../shared/prose';
import type { Loose, Recording, RecordingFit } from '../../shared/result_types';
import { intervalText, significant } from '../../shared/rounding';
import { section } from '../../shared/section';
import { table, type Cell, type Column } from '../../shared/table';
import { inDegrees, spacedUnit, withUnit } from '../../shared/units';
import { noteOf, quantityName, valueCell } from '../parameters';
import { recordingFile, shownFit, type OneRecording, type Report } from '../report';

const number = 'number' as const;

/** "3", with its colour in the plots, and whether it disagrees. */
function recordingName({ number: which, report }: OneRecording): Cell {
  const disagrees = shownFit(report)?.homogeneity?.outliers.includes(which);
  return [swatch(recordingMark(which - 1)), String(which), disagrees && el('small', { class: 'no' }, 'disagrees')];
}

/** "0.0030 rad" for sigma_rad. */
function readingText(object: Loose | null | undefined, name: string): string {
  const found = withUnit(object, name);
  return found ? significant(found.value, 3) + spacedUnit(found.unit) : '–';
}

const startText = ({ start }: Recording): string =>
  start === 'release' ? 'held' : start === 'moving' ? 'in motion' : '–';

function amplitudeText(fit: RecordingFit | undefined): string {
  const amplitude = fit?.amplitude_rad ?? null;
  const degrees = inDegrees('rad');
  return amplitude === null || !degrees ? '–' : significant(amplitude * degrees.factor, 3) + degrees.unit;
}

/** The part of the law shown that belongs to the recording; undefined without a fit. */
const ownFit = ({ data, report }: OneRecording): RecordingFit | undefined => data.fits[report.shown];

function recordingRow(one: OneRecording): Cell[] {
  const { data } = one;
  const fit = ownFit(one);
  return [
    recordingName(one),
    recordingFile(one),
    `${data.used_samples} of ${data.samples}`,
    `${significant(data.window_s[0], 4)} to ${significant(data.window_s[1], 4)}`,
    significant(data.sample_rate_hz, 4),
    startText(data),
    amplitudeText(fit),
    readingText(fit?.noise, 'sigma'),
    readingText(fit?.statistics, 'rms_residual'),
    significant(fit?.noise?.lag1_correlation, 2),
    typeset((fit?.separate ?? '–').replace(/_/g, ' ')),
  ];
}

function recordingTable({ recordings }: Report): HTMLElement {
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
  return table('Recordings', columns, recordings.map(recordingRow));
}

function ownCell(one: OneRecording, name: string): Cell {
  const parameter = ownFit(one)?.parameters[name];
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
function ownTable({ recordings }: Report): HTMLElement | null {
  const names = [...new Set(recordings.flatMap((one) => Object.keys(ownFit(one)?.parameters ?? {})))];
  if (names.length === 0) return null;
  const columns: Column[] = [
    { head: 'Recording' },
    ...names.map((name) => ({ head: el('span', {}, ...quantityName(name)), kind: number })),
  ];
  const rows = recordings.map((one): Cell[] => [
    recordingName(one),
    ...names.map((name) => ownCell(one, name)),
  ]);
  return table('Own parameters of each recording, from the joint fit', columns, rows);
}

export function recordingsSection(report: Report): HTMLElement {
  return section(
    'recordings',
    'The recordings',
    recordingTable(report),
    text('Amplitudes are root mean squares over the motion. Residuals and noise are those of the joint fit.', 'quiet'),
    ownTable(report),
  );
}
