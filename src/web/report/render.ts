// SPDX-License-Identifier: Apache-2.0
/** Builds the report from the result, with or without the series. */

import { fileName } from '../shared/names';
import { fillPage, type Content } from '../shared/page';
import type { Command, Result, Series } from '../shared/result_types';
import { significant } from '../shared/rounding';
import { isJoint } from './joint/joint';
import { jointContent } from './joint/joint_content';
import type { JointResult } from './joint/joint_types';
import { parameterSection } from './parameters';
import { makeReport, shownFit, type Report } from './report';
import { closedFormSection } from './sections/closed_form_section';
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

const kSections: ((report: Report) => HTMLElement | null)[] = [
  verdictSection,
  fitSection,
  (report) => parameterSection(shownFit(report)),
  validationSection,
  envelopeSection,
  phaseSection,
  residualSection,
  correlationSection,
  profileSection,
  comparisonSection,
  constancySection,
  closedFormSection,
  rigSection,
  provenanceSection,
];

/** The report of one recording. `name` is its heading. */
export function reportContent(
  result: Result,
  series: Series | null,
  command: Command | null,
  name = fileName(result.data.path),
): Content {
  const report = makeReport(result, series, command);
  const { data, fits, comparison } = result;
  return {
    kind: 'Pendulum report',
    title: name,
    heading: name,
    facts: `${data.used_samples} of ${data.samples} samples · ${significant(data.duration_s, 4)} s · ${significant(data.sample_rate_hz, 4)} Hz`,
    models: fits,
    recommended: comparison?.recommended,
    shown: report.shown,
    show: (index) => (report.shown = index),
    sections: () => kSections.flatMap((make) => make(report) ?? []),
  };
}

/**
 * Fills `root` with the report of one recording, or of a joint fit, which has one series for each recording. series and
 * command may be null; sections that need them then say that they are missing. Outside `root` only the title and the
 * theme of the page change.
 */
export function render(
  result: Result | JointResult,
  series: Series | Series[] | null,
  command: Command | null,
  root: HTMLElement,
): void {
  const made = isJoint(result)
    ? jointContent(result, Array.isArray(series) ? series : null, command)
    : reportContent(result, Array.isArray(series) ? null : series, command);
  fillPage(root, made);
}
