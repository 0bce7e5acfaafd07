// SPDX-License-Identifier: Apache-2.0
/** The parameters that change from run to run. */

import { el, text } from '../shared/dom';
import { sentence } from '../shared/prose';
import { section } from '../shared/section';
import { wordsOf } from '../shared/units';
import { parametersOf, shownModel, type View } from './view';

export function movedSection(view: View): HTMLElement {
  const title = 'What moved';
  const over = view.summary.trend_by === null ? 'the order of the manifest' : view.summary.trend_by;
  const known = parametersOf(view).filter(({ derived, trend }) => !derived && trend);
  const moving = known.filter(({ trend }) => trend?.is_moving);
  if (known.length === 0) return section('moved', title, text('There are too few recordings for a trend.'));
  if (moving.length === 0) {
    return section('moved', title, text(`Nothing: no parameter of ${shownModel(view)?.model} has a trend over ${over}.`));
  }
  const items = moving.map(({ name, trend }) =>
    el('li', {}, el('strong', {}, `${wordsOf(name)}:`), ` ${sentence(trend?.text ?? '')}`),
  );
  return section('moved', title, el('ul', { class: 'moved' }, ...items), text(`Over ${over}, without the outliers.`, 'quiet'));
}
