// SPDX-License-Identifier: Apache-2.0
/** Rig, calibration, source of the recording, and how the numbers were computed. */

import { details, el, text } from '../../shared/dom';
import { sentence, typeset } from '../../shared/prose';
import type { Command, Loose, Recording, Result, Sampling } from '../../shared/result_types';
import { plusMinus, significant } from '../../shared/rounding';
import { absent, section } from '../../shared/section';
import { facts, scrollBox, table, type Cell } from '../../shared/table';
import { rigWords, spacedUnit, unitText, withUnit } from '../../shared/units';
import { isSeveral, recordingFile, shownFit, shownFitOf, type OneRecording, type Report } from '../report';

function rigTable({ rig }: Result): HTMLElement {
  if (!rig) return text('No rig was given: torques and inertia are in units of the gravity torque G.');
  const rows = Object.entries(rig).map(([name, given]): Cell[] => {
    const [words, unit] = rigWords(name);
    const { value, std_dev: error } = typeof given === 'number' ? { value: given, std_dev: undefined } : given;
    return [[words, el('code', {}, name)], plusMinus(value, error) + spacedUnit(unit)];
  });
  return table(
    'The rig, as given',
    [{ head: 'Quantity' }, { head: 'Value ± standard deviation', kind: 'number' }],
    rows,
  );
}

/** Any value as text: numbers rounded, other values as JSON. */
function plain(value: unknown): string {
  if (typeof value === 'number') return significant(value, 7);
  if (typeof value === 'string') return value;
  if (Array.isArray(value)) return value.map(plain).join(', ');
  return value === null ? 'none' : JSON.stringify(value);
}

/** "angle = −49.6077 + 0.198544 x deg, x in counts" */
export function curveText(calibration: Loose): string | null {
  const { coefficients, angle_unit: unit, input } = calibration;
  if (!Array.isArray(coefficients) || coefficients.length === 0) return null;
  const powers = ['', ' x', ' x²', ' x³'];
  const terms = coefficients.map((c, k) => `${significant(Number(c), 6)}${powers[k] ?? ` x^${k}`}`);
  return `angle = ${terms.join(' + ').replace(/\+ −/g, '− ')}, in ${unit === 'deg' ? 'degrees' : 'rad'}, x in ${plain(input)}`;
}

function calibrationPart({ calibration }: Recording): HTMLElement {
  if (!calibration) return text('No calibration was applied. The readings have the unit of the file.');
  const curve = curveText(calibration);
  const rest = Object.entries(calibration).filter(([, value]) => value !== null);
  return el(
    'div',
    {},
    curve && text(curve),
    facts(rest.map(([name, value]) => [name.replace(/_/g, ' '), plain(value)])),
  );
}

const heading = (one: OneRecording): HTMLElement => el('h3', {}, `Recording ${one.number}: ${recordingFile(one)}`);

/** A single entry if all recordings have the same calibration. */
export function rigSection({ result, recordings }: Report): HTMLElement {
  const [first, ...others] = recordings.map(({ data }) => JSON.stringify(data.calibration));
  const parts = others.every((other) => other === first)
    ? [calibrationPart(recordings[0].data)]
    : recordings.flatMap((one) => [heading(one), calibrationPart(one.data)]);
  return section('rig', 'Calibration and rig', ...parts, rigTable(result));
}

const kLeastJitter = 1e-6; // of an interval; less is rounding of the time stamps

/** "200 Hz, no gaps, 264 samples in a period" */
export function samplingText(sampling: Sampling | null): string {
  if (!sampling) return '–';
  const parts = [`${significant(sampling.rate_hz, 5)} Hz`];
  const { jitter_s: jitter } = sampling;
  if (jitter !== null && jitter * sampling.rate_hz > kLeastJitter)
    parts.push(`intervals vary by ${significant(1e3 * jitter, 2)} ms`);
  parts.push(
    sampling.gaps === 0 ? 'no gaps' : `${sampling.gaps} ${sampling.gaps === 1 ? 'gap' : 'gaps'} of up to ${significant(sampling.longest_gap_s, 3)} s`,
  );
  if (sampling.samples_per_period) parts.push(`${significant(sampling.samples_per_period, 3)} samples in a period`);
  if (sampling.saturated_samples) parts.push(`${sampling.saturated_samples} samples at an end of the sensor’s range`);
  return parts.join(', ');
}

function resolutionText(data: Recording): string {
  const resolution = withUnit(data, 'resolution');
  if (!resolution) return 'none';
  const sources: Record<string, string> = { given: 'given', file: 'from the file', found: 'found in the values' };
  return `${significant(resolution.value, 4)} ${unitText(resolution.unit)}, ${sources[data.resolution_source ?? ''] ?? 'of unknown source'}`;
}

function windowText({ window_s: [from, to], window_reason: why, used_samples: used, samples }: Recording): string {
  const reason = why ? `; ${typeset(why.replace('begins: ', 'begins ').replace('ends: ', 'ends '))}` : '';
  return `${significant(from, 6)} s to ${significant(to, 6)} s, ${used} of ${samples} samples${reason}`;
}

function clockText({ clock_scale: scale, clock_scale_std_dev: error }: Recording): string {
  return scale === 1 && !error
    ? 'true seconds'
    : `a second of the file’s clock is ${plusMinus(scale, error)} true seconds`;
}

/** Source of the samples of a recording. */
function dataRows(one: OneRecording): [string, Cell][] {
  const { data } = one;
  const noise = shownFitOf(one)?.noise;
  return [
    ['file', data.path ?? 'not read from a file'],
    ['SHA-256', el('code', { class: 'hash' }, data.sha256 ?? 'unknown')],
    ['window', windowText(data)],
    ['sampling', samplingText(data.sampling)],
    ['resolution', resolutionText(data)],
    ['clock', clockText(data)],
    ['begins', data.start === 'release' ? 'held, then released' : data.start === 'moving' ? 'in motion' : '–'],
    ['noise model', noise ? `${noise.model}: ${typeset(noise.reason)}` : '–'],
  ];
}

/** How the search for the parameters ended, for those who develop the program; null without a fit. */
function solverDetails(report: Report): HTMLElement | null {
  const fit = shownFit(report);
  if (!fit) return null;
  const { iterations, evaluations, termination } = fit.solver;
  const rows: [string, Cell][] = [
    ['end of the search', sentence(fit.reason)],
    ['steps', `${iterations} iterations, ${evaluations} evaluations of the motion`],
    ['message of the solver', termination],
  ];
  return details('Facts on the numerical search', () => facts(rows));
}

function commandPart(command: Command | null): HTMLElement[] {
  const words = command?.command
    ? scrollBox('Command', el('pre', {}, el('code', {}, command.command)))
    : absent('The command is not part of this report.');
  return [el('h3', {}, 'Command'), words];
}

export function provenanceSection(report: Report): HTMLElement {
  const { recordings, command, result } = report;
  const { tool, schema_version: schema } = result;
  const making: [string, Cell] = ['made by', `${tool.name} ${tool.version}, result schema ${schema}`];
  const parts = isSeveral(report)
    ? [
        ...recordings.flatMap((one) => [heading(one), facts(dataRows(one))]),
        el('h3', {}, 'The joint fit'),
        facts([making]),
      ]
    : [facts([...dataRows(recordings[0]), making])];
  return section('provenance', 'Data and program', ...parts, ...commandPart(command), solverDetails(report));
}
