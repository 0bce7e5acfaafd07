// SPDX-License-Identifier: Apache-2.0
/** The answer of a fit as the JSON words it: verdict, parameters with total errors and their sources, derived values. */

import { banner, warningList } from '../shared/banner';
import { details, el, symbolElement, text, type Child } from '../shared/dom';
import { numberText, sentence, typeset, withTheta } from '../shared/prose';
import type { Comparison, Fit, FitSummary, Result, SummaryQuantity } from '../shared/result_types';
import { section } from '../shared/section';
import { symbolOf, unitText, wordsOf } from '../shared/units';
import { budgetBar, budgetLegend, sourcesOf } from './budget';
import { warningsOf } from './report';

/** "0.0790 ± 0.0028 kg m²", the texts of the JSON. A line can break only before the unit. */
function quantityElement(tag: 'span' | 'strong', { value, error, unit }: SummaryQuantity): HTMLElement {
  const both = typeset(error === '' ? value : `${value} ± ${error}`);
  return el(tag, { class: 'value' }, el('span', {}, both), unit !== '' && ` ${unitText(unit)}`);
}

/** Text in which the symbol of the inertia has a subscript. */
function withSymbols(words: string): HTMLElement {
  const parts = words.split('I_O').flatMap((part, i) => (i === 0 ? [part] : [symbolElement('I_O'), part]));
  return el('p', { class: 'quiet' }, ...parts);
}

const kPhone = '(max-width: 560px)';

/** Which law is recommended, and why; null if only one law was fitted. */
export function recommendation(comparison: Comparison | null, shown: string | null): HTMLElement | null {
  if (!comparison) return null;
  const { recommended } = comparison;
  const why = sentence(comparison.reason);
  const words =
    recommended === null
      ? 'No law is recommended.'
      : recommended === shown
        ? `Recommended law: ${recommended}.`
        : `This is not the recommended law. Recommended: ${recommended}.`;
  const element = el('details', { class: 'recommendation' }, el('summary', {}, el('strong', {}, words)), ` ${why}`);
  element.open = !window.matchMedia(kPhone).matches; // the swing comes first on a small screen
  return element;
}

function verdictBanner(summary: FitSummary, recommended: HTMLElement | null): HTMLElement {
  const { agreement, verdict, level } = summary;
  const first = agreement === '' || level === 'bad';
  const [title, rest] = first ? [verdict, agreement] : [agreement, verdict];
  return banner({ level, title: typeset(title), sentence: typeset(rest) }, recommended);
}

/** If the recordings scatter and no single one disagrees: the random-effects mean, whose error includes the scatter. */
function remarkOf({ homogeneity, status }: Fit, name: string): string | null {
  const scatter = homogeneity?.parameters[name]?.random_effects;
  const scattered = status === 'converged' && homogeneity?.agrees === false && homogeneity.outliers.length === 0;
  return scattered && scatter && scatter.mean !== null
    ? `random effects: ${numberText(scatter.text)}`
    : null;
}

function answerRow(fit: Fit, quantity: SummaryQuantity): HTMLElement {
  const { name, unit, source } = quantity;
  const symbol = symbolOf(name, unit === '' ? '1' : unit);
  const parameter = fit.parameters[name];
  const bar = parameter ? budgetBar(parameter) : null;
  const remark = remarkOf(fit, name);
  return el(
    'tr',
    { 'data-parameter': name },
    el('th', { scope: 'row' }, wordsOf(name), symbol !== null && ' ', symbol !== null && symbolElement(symbol)),
    el(
      'td',
      {},
      quantityElement('span', quantity),
      remark !== null && el('small', {}, remark),
    ),
    el('td', {}, bar, el('small', {}, typeset(source))),
  );
}

/** The parameters with their total errors. */
function answerTable(fit: Fit, summary: FitSummary): HTMLElement {
  const sources = sourcesOf(fit);
  const systematic = sources.some(({ key }) => key !== 'noise');
  const head = ['Parameter', systematic ? 'Value ± total error' : 'Value ± standard error', 'Error from'];
  const rows = summary.parameters.map((quantity) => answerRow(fit, quantity));
  const caption = el('caption', { class: 'unseen' }, `Parameters of ${fit.model}`);
  const heads = el('tr', {}, ...head.map((words) => el('th', { scope: 'col' }, words)));
  const table = el('table', { class: 'answer-table' }, caption, el('thead', {}, heads), el('tbody', {}, ...rows));
  return el('div', { class: 'answer-values' }, table, sources.length > 0 && budgetLegend(sources));
}

/** "period of small swings 1.3151 ± 0.0007 s" */
function derivedList({ derived }: FitSummary): HTMLElement | null {
  if (derived.length === 0) return null;
  const list = el('ul', { class: 'derived', 'aria-label': 'Computed from the parameters' });
  for (const quantity of derived) list.append(el('li', {}, `${quantity.name} `, quantityElement('strong', quantity)));
  return list;
}

/** What the numbers rest on that neither the file nor the user said. */
function assumedText({ assumptions = [] }: FitSummary): HTMLElement | null {
  return assumptions.length === 0 ? null : text(typeset(`Assumed: ${assumptions.join('; ')}.`));
}

/** Warnings of the law that is shown: in short, and with their explanations. */
function warningPart(summary: FitSummary, result: Result, model: string): HTMLElement | null {
  if (summary.warnings.length === 0) return null;
  const list = el('ul', { class: 'warnings' }, ...summary.warnings.map((words) => el('li', {}, sentence(words))));
  const count = summary.warnings.length;
  const full = (): HTMLElement => warningList(warningsOf(result, model));
  return el('div', {}, el('h3', {}, count === 1 ? 'Warning' : `${count} warnings`), list, details('Explanations', full));
}

/** The first section of a report. Its heading is only for screen readers and the table of contents. */
export function answerSection(parts: Child[]): HTMLElement {
  const element = section('verdict', 'Result', ...parts);
  element.classList.add('answer-section');
  element.querySelector('h2')?.classList.add('unseen');
  return element;
}

/** The first screen of a report. */
export function answerPart(fit: Fit, result: Result, swing: HTMLElement | null): Child[] {
  const { summary } = fit;
  const recommended = recommendation(result.comparison, fit.model);
  if (!summary) {
    const why = 'An earlier version of the program made this result, so it has no summary. Fit the recording again.';
    return [banner({ level: 'caution', title: `Fit of the law ${fit.model}`, sentence: why }, recommended), swing];
  }
  const equation = summary.equation === '' ? null : withTheta(typeset(summary.equation));
  const more = el(
    'div',
    { class: 'answer-more' },
    summary.losses ? text(typeset(summary.losses)) : null,
    summary.remarks ? text(typeset(summary.remarks)) : null,
    summary.advice ? text(typeset(summary.advice)) : null,
    derivedList(summary),
    equation !== null && el('p', { class: 'equation' }, equation),
    summary.units !== '' && text(typeset(summary.units), 'quiet'),
    summary.textbook !== '' && withSymbols(typeset(summary.textbook)),
    assumedText(summary),
    warningPart(summary, result, fit.model),
  );
  const values =
    summary.parameters.length > 0
      ? answerTable(fit, summary)
      : text('There are no parameters to show.', 'absent');
  return [verdictBanner(summary, recommended), el('div', { class: 'answer' }, values, swing, more)];
}
