// SPDX-License-Identifier: Apache-2.0
/** The answer: verdict, parameters with total errors, and the swing with the fit. */

import { banner, warnings } from '../../shared/banner';
import { answerPart, answerSection } from '../answer';
import { jointSwing } from '../joint/overlay_section';
import { isSeveral, shownFit, type Report } from '../report';
import { swingFigure } from '../swing';

const kNoFit = {
  level: 'caution',
  title: 'Nothing was fitted',
  sentence: 'Only the formulas of the linear pendulum were asked for.',
} as const;

export function verdictSection(report: Report): HTMLElement {
  const fit = shownFit(report);
  const { result, recordings } = report;
  const swing = isSeveral(report) ? jointSwing(report) : swingFigure(recordings[0]);
  return answerSection(fit ? answerPart(fit, result, swing) : [banner(kNoFit), swing, warnings(result)]);
}
