// SPDX-License-Identifier: Apache-2.0
/** Heading and sections of a report, with or without the series. */

import { placesInGuide } from '../shared/guide';
import { fileName } from '../shared/names';
import type { Content } from '../shared/page';
import { inList } from '../shared/prose';
import { significant } from '../shared/rounding';
import { agreementSection } from './joint/agreement_section';
import { oneRecordingPart } from './joint/one_recording';
import { overlaySection } from './joint/overlay_section';
import { recordingsSection } from './joint/recordings_section';
import { isSeveral, recordingFile, shownFit, warningsOf, type Report } from './report';
import { comparisonSection } from './sections/comparison_section';
import { constancySection } from './sections/constancy_section';
import { correlationSection } from './sections/correlation_section';
import { envelopeSection } from './sections/envelope_section';
import { fitSection } from './sections/fit_section';
import { phaseSection } from './sections/phase_section';
import { profileSection } from './sections/profile_section';
import { provenanceSection, rigSection } from './sections/provenance_section';
import { residualSection } from './sections/residual_section';
import { validationSection } from './sections/validation_section';
import { verdictSection } from './sections/verdict_section';
import { otherParts, parameterPart, toldPart } from './told';

type Sections = (HTMLElement | null)[];

function sectionsOfOne(report: Report): Sections {
  const [one] = report.recordings;
  return [
    fitSection(one),
    parameterPart(report),
    validationSection(one),
    envelopeSection(one),
    phaseSection(one),
    residualSection(one),
    correlationSection(report),
    profileSection(report),
    comparisonSection(report),
    constancySection(one),
    toldPart(report, 'closed-forms', 'Closed forms'),
    toldPart(report, 'data', 'Data'),
  ];
}

const sectionsOfSeveral = (report: Report, changed: () => void): Sections => [
  agreementSection(report),
  parameterPart(report),
  recordingsSection(report),
  overlaySection(report),
  oneRecordingPart(report, changed),
  correlationSection(report),
  profileSection(report),
  comparisonSection(report),
];

const kMostNames = 6;

/** "a.csv, b.csv and 3 more" */
function names({ recordings }: Report): string {
  const all = recordings.map(recordingFile);
  return all.length <= kMostNames
    ? inList(all)
    : inList([...all.slice(0, kMostNames - 1), `${all.length - kMostNames + 1} more`]);
}

/** `name`: of a single recording. */
function titleOf(report: Report, name: string | undefined): Pick<Content, 'title' | 'heading' | 'facts'> {
  const all = report.recordings.map(({ data }) => data);
  if (isSeveral(report)) {
    const title = `${all.length} recordings`;
    const samples = all.reduce((sum, data) => sum + data.used_samples, 0);
    return { title, heading: `${title}, fitted together`, facts: `${names(report)} · ${samples} samples` };
  }
  const [{ path, used_samples: used, samples, duration_s: duration, sample_rate_hz: rate }] = all;
  const title = name ?? fileName(path);
  const facts = `${used} of ${samples} samples · ${significant(duration, 4)} s · ${significant(rate, 4)} Hz`;
  return { title, heading: title, facts };
}

/** Codes of the warnings of the law that is shown. */
const codesOf = (report: Report): string[] =>
  warningsOf(report.result, shownFit(report)?.model ?? '').map(({ code }) => code);

/** The report. `name` is its heading, by default the name of the file. */
export function reportContent(report: Report, name?: string): Content {
  const { fits, comparison } = report.result;
  const own = isSeveral(report) ? sectionsOfSeveral : sectionsOfOne;
  return {
    kind: 'Pendulum report',
    ...titleOf(report, name),
    models: fits,
    recommended: comparison?.recommended,
    shown: report.shown,
    show: (index) => (report.shown = index),
    sections: (changed) => {
      const made = [
        verdictSection(report),
        ...own(report, changed),
        toldPart(report, 'warnings', 'Warnings', [placesInGuide(codesOf(report))]),
        ...otherParts(report),
        rigSection(report),
        provenanceSection(report),
      ];
      return made.flatMap((part) => part ?? []);
    },
  };
}
