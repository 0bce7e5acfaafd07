// SPDX-License-Identifier: Apache-2.0
/** The verdict: number of recordings, what was taken for one pendulum, and whether the errors agree with the scatter. */

import { banner, warnings, type Level } from '../shared/banner';
import { el, text, type Child } from '../shared/dom';
import { keyFigure } from '../shared/key_figure';
import { localTime } from '../shared/local_time';
import { numberText, sentence } from '../shared/prose';
import { section } from '../shared/section';
import { wordsOf } from '../shared/units';
import { headline, judgedOf, worst } from './headline';
import { disagreementText } from './outliers_section';
import type { Summary } from './types';
import { parametersOf, shownModel, type View } from './view';
import { countText, shareText } from './words';

function scatterFigure(view: View): HTMLElement | null {
  const most = worst(judgedOf(view));
  if (!most || most.repeatability.scatter_ratio === null) return null;
  return keyFigure(['largest scatter'], `${numberText(most.repeatability.texts.scatter_ratio)} × the errors`, [
    `${wordsOf(most.name)}; 1: as much as the errors predict`,
  ]);
}

function figures(view: View): HTMLElement {
  const { store } = view.summary;
  const model = shownModel(view);
  const outliers = parametersOf(view).reduce((sum, one) => sum + one.outliers_total, 0);
  const box = el('div', { class: 'figures' });
  const pending = store.pending === 0 ? 'none is pending' : `${countText(store.pending)} pending`;
  const { headline: counts } = view.summary;
  box.append(keyFigure(['recordings fitted'], `${countText(counts.fitted)} of ${countText(counts.runs)}`, [pending]));
  if (model) {
    const share = `${shareText(model.converged, model.fits)} of its fits`;
    box.append(
      keyFigure([`converged: ${model.model}`], `${countText(model.converged)} of ${countText(model.fits)}`, [share]),
    );
  }
  const scatter = scatterFigure(view);
  if (scatter) box.append(scatter);
  if (model && model.converged > 0) {
    const joint = (view.summary.agreement?.rows ?? []).reduce((sum, row) => sum + row.outliers.length, 0);
    const values = [`outlying values of single parameters: ${countText(outliers)}`];
    box.append(keyFigure(['recordings that disagree'], countText(joint), values));
  }
  return box;
}

/** When the batch was fitted, and what was new. */
function refitParts({ refit }: Summary): Child[] {
  if (!refit || refit.began === null) return [];
  const ended: Child[] = refit.ended === null ? [', not ended'] : [', ended ', localTime(refit.ended)];
  return [
    el('p', { class: 'quiet when' }, 'Last refit: began ', localTime(refit.began), ...ended, ', your local time.'),
    refit.text !== null && text(sentence(refit.text)),
  ];
}

/** Whether it may be said that there is no warning. */
const isFine = ({ headline: counts, disagreement, warnings: list }: Summary, level: Level): boolean =>
  list.length > 0 || (level === 'good' && counts.fitted === counts.runs && !disagreement);

export function verdictSection(view: View): HTMLElement {
  const { summary } = view;
  const disagreement = disagreementText(summary);
  const top = headline(view);
  return section(
    'verdict',
    'Verdict',
    banner(top),
    ...refitParts(summary),
    disagreement !== '' && text(disagreement),
    figures(view),
    isFine(summary, top.level) && warnings(summary),
  );
}
