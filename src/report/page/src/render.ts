// SPDX-License-Identifier: Apache-2.0
/** The whole report from the result, with or without its samples. */

import { closedFormSection } from './closed_form_section';
import { comparisonSection } from './comparison_section';
import { constancySection } from './constancy_section';
import { correlationSection } from './correlation_section';
import { envelopeSection } from './envelope_section';
import { fitSection } from './fit_section';
import { isJoint } from './joint';
import { jointContent } from './joint_content';
import type { JointResult } from './joint_types';
import { fillPage, type Content } from './page';
import { phaseSection } from './phase_section';
import { profileSection } from './profile_section';
import { provenanceSection, rigSection } from './provenance_section';
import { fileName, makeReport, type Report } from './report';
import { residualSection } from './residual_section';
import { significant } from './rounding';
import type { Command, Result, Series } from './types';
import { validationSection } from './validation_section';
import { verdictSection } from './verdict';

const kSections: ((report: Report) => HTMLElement | null)[] = [
  verdictSection,
  fitSection,
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

/** The report of one recording, by the name of its file or another one. */
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
 * Fills `root` with the report of one recording, or of several fitted together, whose series are as many. series and
 * command may be null; then what needs them says so. The only thing that it changes outside `root` are the title and
 * the theme of the page.
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
