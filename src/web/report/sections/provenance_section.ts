// SPDX-License-Identifier: Apache-2.0
/** Rig, calibration, source of the recording, and how the numbers were computed. */

import { details, el, text } from '../../shared/dom';
import { sentence, typeset } from '../../shared/prose';
import type { Command, Data, Fit, Loose, Result, Sampling } from '../../shared/result_types';
import { plusMinus, significant } from '../../shared/rounding';
import { absent, section } from '../../shared/section';
import { facts, scrollBox, table, type Cell } from '../../shared/table';
import { rigWords, spacedUnit, unitText, withUnit } from '../../shared/units';
import { shownFit, type Report } from '../report';

export function rigTable({ rig }: Pick<Result, 'rig'>): HTMLElement {
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

export function calibrationPart({ calibration }: Pick<Result, 'calibration'>): HTMLElement {
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

export function rigSection({ result }: Report): HTMLElement {
  return section('rig', 'Calibration and rig', calibrationPart(result), rigTable(result));
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

function resolutionText(data: Data): string {
  const resolution = withUnit(data, 'resolution');
  if (!resolution) return 'none';
  const sources: Record<string, string> = { given: 'given', file: 'from the file', found: 'found in the values' };
  return `${significant(resolution.value, 4)} ${unitText(resolution.unit)}, ${sources[data.resolution_source ?? ''] ?? 'of unknown source'}`;
}

function windowText({ window_s: [from, to], window_reason: why, used_samples: used, samples }: Data): string {
  const reason = why ? `; ${typeset(why.replace('begins: ', 'begins ').replace('ends: ', 'ends '))}` : '';
  return `${significant(from, 6)} s to ${significant(to, 6)} s, ${used} of ${samples} samples${reason}`;
}

function clockText({ clock_scale: scale, clock_scale_std_dev: error }: Data): string {
  return scale === 1 && !error
    ? 'true seconds'
    : `a second of the file’s clock is ${plusMinus(scale, error)} true seconds`;
}

/** Source of the samples of a recording. */
export function dataRows(data: Data, fit: Fit | null): [string, Cell][] {
  return [
    ['file', data.path ?? 'not read from a file'],
    ['SHA-256', el('code', { class: 'hash' }, data.sha256 ?? 'unknown')],
    ['window', windowText(data)],
    ['sampling', samplingText(data.sampling)],
    ['resolution', resolutionText(data)],
    ['clock', clockText(data)],
    ['begins', data.start === 'release' ? 'held, then released' : data.start === 'moving' ? 'in motion' : '–'],
    ['noise model', fit?.noise ? `${fit.noise.model}: ${typeset(fit.noise.reason)}` : '–'],
  ];
}

/** Program that made the report. */
export const makingRows = ({ tool, schema_version: schema }: Pick<Result, 'tool' | 'schema_version'>): [string, Cell][] => [
  ['made by', `${tool.name} ${tool.version}, result schema ${schema}`],
];

/** How the search for the parameters ended, for those who develop the program; null without a fit. */
export function solverDetails(fit: Pick<Fit, 'solver' | 'reason'> | null): HTMLElement | null {
  if (!fit) return null;
  const { iterations, evaluations, termination } = fit.solver;
  const rows: [string, Cell][] = [
    ['end of the search', sentence(fit.reason)],
    ['steps', `${iterations} iterations, ${evaluations} evaluations of the motion`],
    ['message of the solver', termination],
  ];
  return details('Facts on the numerical search', () => facts(rows));
}

export function commandPart(command: Command | null): HTMLElement[] {
  const words = command?.command
    ? scrollBox('Command', el('pre', {}, el('code', {}, command.command)))
    : absent('The command is not part of this report.');
  return [el('h3', {}, 'Command'), words];
}

export const kProvenanceTitle = 'Data and program';

export function provenanceSection(report: Report): HTMLElement {
  const fit = shownFit(report);
  const rows = [...dataRows(report.result.data, fit), ...makingRows(report.result)];
  return section('provenance', kProvenanceTitle, facts(rows), ...commandPart(report.command), solverDetails(fit));
}
