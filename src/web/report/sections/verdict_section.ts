// SPDX-License-Identifier: Apache-2.0
/** The answer: verdict, parameters with total errors, and the swing with the fit. */

import { banner, warnings } from '../../shared/banner';
import { answerPart, answerSection } from '../answer';
import { shownFit, type Report } from '../report';
import { swingFigure } from '../swing';

export const kNoFit = {
  level: 'caution',
  title: 'Nothing was fitted',
  sentence: 'Only the formulas of the linear pendulum were asked for.',
} as const;

export function verdictSection(report: Report): HTMLElement {
  const fit = shownFit(report);
  const swing = swingFigure(report);
  const parts = fit
    ? answerPart({ fit, result: report.result, swing })
    : [banner(kNoFit), swing, warnings(report.result)];
  return answerSection(parts);
}
