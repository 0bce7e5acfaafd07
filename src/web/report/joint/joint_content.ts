// SPDX-License-Identifier: Apache-2.0
/** The report of several recordings that were fitted together. */

import type { Content } from '../../shared/page';
import { inList } from '../../shared/prose';
import type { Command, Series } from '../../shared/result_types';
import { parameterSection } from '../parameters';
import { shownFit } from '../report';
import { comparisonSection } from '../sections/comparison_section';
import { correlationSection } from '../sections/correlation_section';
import { profileSection } from '../sections/profile_section';
import { agreementSection } from './agreement_section';
import { makeJointReport, recordingFile, showModel, type JointReport } from './joint';
import { jointProvenanceSection, jointRigSection } from './joint_provenance_section';
import type { JointResult } from './joint_types';
import { jointVerdictSection } from './joint_verdict_section';
import { oneRecordingPart } from './one_recording';
import { overlaySection } from './overlay_section';
import { recordingsSection } from './recordings_section';

const kMostNames = 6;

/** "a.csv, b.csv and 3 more" */
function names(result: JointResult): string {
  const all = result.data.map((_data, k) => recordingFile(result, k));
  return all.length <= kMostNames
    ? inList(all)
    : inList([...all.slice(0, kMostNames - 1), `${all.length - kMostNames + 1} more`]);
}

function sections(report: JointReport, changed: () => void): HTMLElement[] {
  const whole = report.whole;
  const made = [
    jointVerdictSection(report),
    agreementSection(report),
    parameterSection(shownFit(whole), 'What the recordings do not determine'),
    recordingsSection(report),
    overlaySection(report),
    oneRecordingPart(report, changed),
    correlationSection(whole),
    profileSection(whole),
    comparisonSection(whole),
    jointRigSection(report),
    jointProvenanceSection(report),
  ];
  return made.flatMap((part) => part ?? []);
}

export function jointContent(result: JointResult, series: Series[] | null, command: Command | null): Content {
  const report = makeJointReport(result, series, command);
  const samples = result.data.reduce((sum, data) => sum + data.used_samples, 0);
  const count = `${result.data.length} recordings`;
  return {
    kind: 'Pendulum report',
    title: count,
    heading: `${count}, fitted together`,
    facts: `${names(result)} · ${samples} samples`,
    models: result.fits,
    recommended: result.comparison?.recommended,
    shown: report.whole.shown,
    show: (index) => showModel(report, index),
    sections: (changed) => sections(report, changed),
  };
}
