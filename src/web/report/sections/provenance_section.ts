// SPDX-License-Identifier: Apache-2.0
/** Rig, calibration, source of the recording, and how the numbers were computed. */

import { el, text } from '../../shared/dom';
import type { Loose, Recording } from '../../shared/result_types';
import { significant } from '../../shared/rounding';
import { absent, section } from '../../shared/section';
import { facts, scrollBox, type Cell } from '../../shared/table';
import { isSeveral, recordingFile, type OneRecording, type Report } from '../report';
import { told } from '../told';

/** Any value as text: numbers rounded, other values as JSON. */
function plain(value: unknown): string {
  if (typeof value === 'number') return significant(value, 7);
  if (typeof value === 'string') return value;
  if (Array.isArray(value)) return value.map(plain).join(', ');
  return value === null ? 'none' : JSON.stringify(value);
}

const given = (values: Loose): HTMLElement =>
  facts(Object.entries(values).filter(([, value]) => value !== null).map(([name, value]) => [name.replace(/_/g, ' '), plain(value)]));

const rigPart = (report: Report): HTMLElement[] =>
  report.result.rig
    ? told(report, 'rig', 'Calibration and rig')
    : [text('No rig was given: torques and inertia are in units of the gravity torque G.')];

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
  return el('div', {}, curve && text(curve), given(calibration));
}

const heading = (one: OneRecording): HTMLElement => el('h3', {}, `Recording ${one.number}: ${recordingFile(one)}`);

/** A single entry if all recordings have the same calibration. */
export function rigSection(report: Report): HTMLElement {
  const { recordings } = report;
  const [first, ...others] = recordings.map(({ data }) => JSON.stringify(data.calibration));
  const parts = others.every((other) => other === first)
    ? [calibrationPart(recordings[0].data)]
    : recordings.flatMap((one) => [heading(one), calibrationPart(one.data)]);
  return section('rig', 'Calibration and rig', ...parts, ...rigPart(report));
}

/** Files with their hashes, the program and its command, and how the search for the parameters ended. */
export function provenanceSection(report: Report): HTMLElement {
  const { recordings, command, result } = report;
  const { tool, schema_version: schema } = result;
  const several = isSeveral(report);
  const files = recordings.flatMap(({ data: { path, sha256 }, number }): [string, Cell][] => [
    [several ? `file ${number}` : 'file', path ?? 'not read from a file'],
    ['SHA-256', el('code', { class: 'hash' }, sha256 ?? 'unknown')],
  ]);
  const list = facts([...files, ['made by', `${tool.name} ${tool.version}, result schema ${schema}`]]);
  list.classList.add('lines');
  const words = command?.command
    ? scrollBox('Command', el('pre', {}, el('code', {}, command.command)))
    : absent('The command is not part of this report.');
  const title = 'Files and program';
  return section('provenance', title, list, el('h3', {}, 'Command'), words, ...told(report, 'provenance', title));
}
