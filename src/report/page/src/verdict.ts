// SPDX-License-Identifier: Apache-2.0
/** The verdict: what was found, and whether it may be believed. */

import { el, text } from './dom';
import { equationText } from './equation';
import { headline, type Headline, type Level } from './headline';
import { keyFigures, parameterPart } from './parameters';
import { sentence } from './prose';
import { shownFit, type Report } from './report';
import { section } from './section';
import type { Result } from './types';

const kSigns: Record<Level, string> = { good: '✓', caution: '!', bad: '✕' };

export function banner({ level, title, sentence: words }: Headline): HTMLElement {
  const box = el('div', {}, el('p', { class: 'title' }, title), el('p', {}, words));
  return el(
    'div',
    { class: `banner ${level}` },
    el('span', { class: 'sign', 'aria-hidden': 'true' }, kSigns[level]),
    box,
  );
}

/** Which model and why; nothing where one was fitted. */
export function recommendation({ result }: Report): HTMLElement | null {
  const { comparison } = result;
  if (!comparison) return null;
  const label =
    comparison.recommended === null ? 'No model is recommended.' : `Recommended model: ${comparison.recommended}.`;
  return el('p', { class: 'recommendation' }, el('strong', {}, label), ` ${sentence(comparison.reason ?? '')}`);
}

export function warnings({ warnings: list }: Pick<Result, 'warnings'>): HTMLElement | null {
  if (list.length === 0) return el('p', { class: 'quiet' }, 'No warnings.');
  const items = el('ul', { class: 'warnings' });
  for (const { code, message } of list) {
    items.append(el('li', {}, el('span', { class: 'code' }, code.replace(/_/g, ' ')), ' ', sentence(message)));
  }
  return el('div', {}, el('h3', {}, list.length === 1 ? 'Warning' : `Warnings (${list.length})`), items);
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
