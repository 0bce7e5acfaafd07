// SPDX-License-Identifier: Apache-2.0
/** The headline of a batch: how many recordings were fitted, which are compared, and whether their errors are right. */

import type { Headline, Level } from '../shared/banner';
import { visible } from '../shared/names';
import { sentence } from '../shared/prose';
import type { ModelCounts, ParameterSummary, Summary } from './types';
import { parametersOf, shownModel, type View } from './view';
import { counted } from './words';

const kFew = 0.5; // of the fits; if fewer converged, the summary is not representative
const kMost = 0.9;

type Judged = ParameterSummary & { repeatability: NonNullable<ParameterSummary['repeatability']> };

/** The parameters that have several runs of one rig; without derived quantities, as in the verdict's sentence. */
export const judgedOf = (view: View): Judged[] =>
  parametersOf(view).filter((one): one is Judged => one.repeatability !== null && !one.derived);

/** The parameter that the verdict names: of those that scatter by more than their errors (of all, if none does), the
 *  one with the largest scatter in units of its errors; null if no scatter is known. */
export function worst(all: Judged[]): Judged | null {
  const larger = all.filter(({ repeatability }) => repeatability.verdict === 'scatter_larger');
  const judged = larger.length > 0 ? larger : all;
  const ratio = (one: Judged): number => one.repeatability.scatter_ratio ?? 0;
  return judged.reduce<Judged | null>((most, one) => (most && ratio(most) >= ratio(one) ? most : one), null);
}

function nothing(view: View): Headline | null {
  const { store, models, failures } = view.summary;
  if (store.fits === 0) {
    const pending = store.pending === 0 ? '' : `${counted(store.pending, 'run')} to be fitted yet.`;
    return { level: 'bad', title: 'Nothing has been fitted', sentence: pending };
  }
  if (models.some(({ converged }) => converged > 0)) return null;
  const reason = failures.reduce((most, one) => (one.fits > most.fits ? one : most), failures[0]);
  const why = reason ? `Most often (${counted(reason.fits, 'fit')}): ${reason.reason}` : '';
  return {
    level: 'bad',
    title: `${view.summary.headline.text}: no fit converged`,
    sentence: sentence(why),
  };
}

function levelOf({ converged, fits }: ModelCounts, { disagreement }: Summary, otherwise: Level): Level {
  if (converged < kFew * fits) return 'bad';
  return otherwise === 'good' && (converged < kMost * fits || disagreement) ? 'caution' : otherwise;
}

export function headline(view: View): Headline {
  const none = nothing(view);
  const model = shownModel(view);
  if (none || !model) return none ?? { level: 'bad', title: 'There is no model to show', sentence: '' };
  const { headline: counts, grouping } = view.summary;
  const verdict = view.summary.verdicts.find((one) => one.model === model.model);
  const otherwise = grouping.otherwise === null ? '' : ` ${grouping.otherwise}`;
  const groups = `${visible(grouping.text)}${otherwise}`;
  if (model.converged === 0) {
    const none = `No fit of ${model.model} converged.`;
    return { level: 'bad', title: counts.text, sentence: `${none} ${groups}` };
  }
  const found = grouping.is_compared && verdict ? ` ${verdict.text}` : '';
  return { level: levelOf(model, view.summary, verdict?.level ?? 'caution'), title: counts.text, sentence: groups + found };
}
