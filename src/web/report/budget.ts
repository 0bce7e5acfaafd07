// SPDX-License-Identifier: Apache-2.0
/** The error budget of a parameter: how much of its variance comes from each source. */

import { el } from '../shared/dom';
import { inList } from '../shared/prose';
import type { Fit, Parameter } from '../shared/result_types';

/** Sources of errors in the order in which they are shown: name in JSON, short name, what it is, colour. */
export const kSources = [
  { key: 'noise', name: 'noise', words: 'noise of the readings', colour: 'budget-noise' },
  { key: 'rig', name: 'rig', words: 'masses and lengths of the rig', colour: 'budget-rig' },
  { key: 'calibration', name: 'calibration', words: 'calibration of the sensor', colour: 'budget-calibration' },
  { key: 'clock', name: 'clock', words: 'clock of the recorder', colour: 'budget-clock' },
  { key: 'sensor', name: 'sensor', words: 'what the sensor may do', colour: 'budget-sensor' },
  { key: 'inconstancy', name: 'change during the recording', words: 'change during the recording', colour: 'budget-inconstancy' },
  { key: 'friction_law', name: 'another friction law', words: 'friction of another law', colour: 'budget-law' },
] as const;

export type Source = (typeof kSources)[number];

export interface Share {
  source: Source;
  /** Standard error from this source. */
  error: number;
  /** Of the variance, 0 to 1. */
  share: number;
}

/** The shares of the variance of a parameter, without sources that contribute nothing; empty without an error. */
export function sharesOf({ error_budget: budget }: Pick<Parameter, 'error_budget'>): Share[] {
  const parts = kSources.flatMap((source) => {
    const error = budget?.[source.key];
    return typeof error === 'number' && error > 0 ? [{ source, error }] : [];
  });
  const largest = Math.max(0, ...parts.map((part) => part.error)); // keeps squares of tiny errors above zero
  const total = parts.reduce((sum, { error }) => sum + (error / largest) ** 2, 0);
  return parts.map((part) => ({ ...part, share: (part.error / largest) ** 2 / total }));
}

const kLeastPercent = 0.5;

function percent(share: number): string {
  return 100 * share < kLeastPercent ? 'less than 1 %' : `${Math.round(100 * share)} %`;
}

/** "Variance: 63 % calibration, 37 % clock." */
export function budgetSentence(shares: Share[]): string {
  const largestFirst = [...shares].sort((a, b) => b.share - a.share);
  return `Variance: ${inList(largestFirst.map(({ source, share }) => `${percent(share)} ${source.name}`))}.`;
}

/** A bar with a part for each source; null without an error. */
export function budgetBar(parameter: Parameter): HTMLElement | null {
  const shares = sharesOf(parameter);
  if (shares.length === 0) return null;
  const sentence = budgetSentence(shares);
  const bar = el('div', { class: 'budget', role: 'img', 'aria-label': sentence, title: sentence });
  for (const { source, share } of shares) {
    const part = el('span');
    part.style.flexGrow = String(share);
    part.style.background = `var(--${source.colour})`;
    bar.append(part);
  }
  return bar;
}

/** Sources that contribute to the error of any parameter. */
export function sourcesOf(fit: Pick<Fit, 'parameters'>): Source[] {
  const keys = new Set(Object.values(fit.parameters).flatMap((parameter) => sharesOf(parameter).map(({ source }) => source)));
  return kSources.filter((source) => keys.has(source));
}

/** What the colours of the bars mean. */
export function budgetLegend(sources: Source[]): HTMLElement {
  const list = el('ul', { class: 'legend budget-legend', 'aria-label': 'Sources of the errors' });
  for (const { name, words, colour } of sources) {
    const square = el('span', { class: 'square' });
    square.style.background = `var(--${colour})`;
    list.append(el('li', { title: words }, square, name));
  }
  return list;
}
