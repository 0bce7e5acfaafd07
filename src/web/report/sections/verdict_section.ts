// SPDX-License-Identifier: Apache-2.0
/** The verdict: the parameters, and whether they are a result. */

import { banner, warnings } from '../../shared/banner';
import { el, text } from '../../shared/dom';
import { sentence } from '../../shared/prose';
import { section } from '../../shared/section';
import { equationText } from '../equation';
import { headline } from '../headline';
import { keyFigures, parameterPart } from '../parameters';
import { shownFit, type Report } from '../report';

/** The recommended model and the reason; null if only one model was fitted. */
export function recommendation({ result }: Report): HTMLElement | null {
  const { comparison } = result;
  if (!comparison) return null;
  const label =
    comparison.recommended === null ? 'No model is recommended.' : `Recommended model: ${comparison.recommended}.`;
  return el('p', { class: 'recommendation' }, el('strong', {}, label), ` ${sentence(comparison.reason ?? '')}`);
}

export function verdictSection(report: Report): HTMLElement {
  const fit = shownFit(report);
  const equation = fit && equationText(fit);
  const usable = fit && Object.keys(fit.parameters ?? {}).length > 0;
  return section(
    'verdict',
    'Verdict',
    banner(headline(report.result, fit)),
    recommendation(report),
    usable && keyFigures(fit),
    equation && el('p', { class: 'equation' }, equation),
    warnings(report.result),
    usable ? parameterPart(fit) : fit && text('There are no parameters to show.', 'absent'),
  );
}
