// SPDX-License-Identifier: Apache-2.0
/** Rig, calibrations and sources of all recordings of a joint fit. */

import { el } from '../../shared/dom';
import { section } from '../../shared/section';
import { facts } from '../../shared/table';
import { shownFit } from '../report';
import {
  calibrationPart,
  commandPart,
  dataRows,
  kProvenanceTitle,
  makingRows,
  rigTable,
  solverDetails,
} from '../sections/provenance_section';
import { recordingFile, type JointReport } from './joint';

const heading = ({ result }: JointReport, k: number): HTMLElement =>
  el('h3', {}, `Recording ${k + 1}: ${recordingFile(result, k)}`);

/** A single entry if all recordings have the same calibration. */
export function jointRigSection(report: JointReport): HTMLElement {
  const { calibration, rig } = report.result;
  const same = calibration.every((other) => JSON.stringify(other) === JSON.stringify(calibration[0]));
  const parts = same
    ? [calibrationPart({ calibration: calibration[0] ?? null })]
    : calibration.flatMap((one, k) => [heading(report, k), calibrationPart({ calibration: one })]);
  return section('rig', 'Calibration and rig', ...parts, rigTable({ rig }));
}

export function jointProvenanceSection(report: JointReport): HTMLElement {
  const { whole, recordings } = report;
  return section(
    'provenance',
    kProvenanceTitle,
    ...recordings.flatMap((one, k) => [heading(report, k), facts(dataRows(one.result.data, shownFit(one)))]),
    el('h3', {}, 'The joint fit'),
    facts(makingRows(whole.result)),
    ...commandPart(whole.command),
    solverDetails(shownFit(whole)),
  );
}
