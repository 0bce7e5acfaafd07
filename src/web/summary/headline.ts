// SPDX-License-Identifier: Apache-2.0
/** The headline of a batch: how many fits converged, and whether the error bars agree with the scatter. */

import type { Headline, Level } from '../shared/banner';
import { inList, sentence } from '../shared/prose';
import { wordsOf } from '../shared/units';
import { hasEnoughRuns } from './repeatability';
import type { ModelCounts, ParameterSummary } from './types';
import { parametersOf, shownModel, type View } from './view';
import { counted, countText, ratioText } from './words';

const kFew = 0.5; // of the fits; if fewer converged, the summary is not representative
const kMost = 0.9;
const kNamed = 4; // parameters that are named

type Judged = ParameterSummary & { repeatability: NonNullable<ParameterSummary['repeatability']> };

/** The parameters that have several runs of one rig. */
export const judgedOf = (view: View): Judged[] =>
  parametersOf(view).filter((one): one is Judged => one.repeatability !== null);

/** The parameter with the largest scatter in units of its error bars; null if no scatter is known. */
export function worst(judged: Judged[]): Judged | null {
  const ratio = (one: Judged): number => one.repeatability.scatter_ratio ?? 0;
  return judged.reduce<Judged | null>((most, one) => (most && ratio(most) >= ratio(one) ? most : one), null);
}

/** "inertia, dry friction and 3 more" */
function names(of: Judged[]): string {
  const words = of.map(({ name }) => wordsOf(name));
  return inList(words.length <= kNamed ? words : [...words.slice(0, kNamed - 1), `${words.length - kNamed + 1} more`]);
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
    title: `None of ${counted(store.fits, 'fit')} converged: there is nothing to summarise`,
    sentence: sentence(why),
  };
}

interface Bars {
  level: Level;
  /** The words after "1980 of 2000 fits of coulomb converged". */
  title: string;
  sentence: string;
}

/** Whether the error bars agree with the scatter of the runs. */
function errorBars(view: View): Bars {
  const judged = judgedOf(view);
  const larger = judged.filter(({ repeatability }) => repeatability.verdict === 'scatter_larger');
  const smaller = judged.filter(({ repeatability }) => repeatability.verdict === 'scatter_smaller');
  if (judged.length === 0) {
    const why = parametersOf(view).find((one) => one.repeatability_reason)?.repeatability_reason ?? '';
    return { level: 'caution', title: '; whether their error bars are true is not known', sentence: sentence(why) };
  }
  const most = worst(larger);
  if (most) {
    const ratio = ratioText(most.repeatability.scatter_ratio);
    const title = `, but scatter up to ${ratio} times as much as their error bars say`;
    const words = `Runs of one rig differ by more than their errors in ${names(larger)} (${larger.length} of ${counted(judged.length, 'parameter')} that can be compared).`;
    return { level: 'caution', title, sentence: words };
  }
  if (smaller.length > 0) {
    const words = `Runs of one rig differ by less than their errors in ${names(smaller)}; the errors are on the safe side.`;
    return { level: 'good', title: ', and their error bars are not too small', sentence: words };
  }
  if (!judged.some(({ repeatability }) => hasEnoughRuns(repeatability))) {
    const words = 'Runs of one rig scatter as much as their errors predict, but are too few to prove these.';
    return { level: 'good', title: '; the runs agree with their error bars', sentence: words };
  }
  const compared = counted(judged.length, 'parameter');
  return {
    level: 'good',
    title: ', and their error bars are true',
    sentence: `Runs of one rig scatter as much as their errors predict, in ${judged.length === 1 ? 'the one parameter' : `all ${compared}`} that can be compared.`,
  };
}

const levelOf = ({ converged, fits }: ModelCounts, otherwise: Level): Level =>
  converged < kFew * fits ? 'bad' : converged < kMost * fits && otherwise === 'good' ? 'caution' : otherwise;

export function headline(view: View): Headline {
  const none = nothing(view);
  const model = shownModel(view);
  if (none || !model) return none ?? { level: 'bad', title: 'There is no model to show', sentence: '' };
  const { pending } = view.summary.store;
  const waiting =
    pending === 0 ? '' : ` ${counted(pending, 'run')} ${pending === 1 ? 'has' : 'have'} not been fitted yet.`;
  const count = `${countText(model.converged)} of ${counted(model.fits, 'fit')} of ${model.model} converged`;
  if (model.converged === 0)
    return { level: 'bad', title: count, sentence: `There is nothing to summarise of this model.${waiting}` };
  const bars = errorBars(view);
  return { level: levelOf(model, bars.level), title: count + bars.title, sentence: (bars.sentence + waiting).trim() };
}
