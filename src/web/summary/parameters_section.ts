// SPDX-License-Identifier: Apache-2.0
/** Table of all parameters of the selected model, in which one can be selected. */

import { button, el, text, type Child } from '../shared/dom';
import { numberText } from '../shared/prose';
import { absent, section } from '../shared/section';
import { select } from '../shared/select';
import { table, type Cell, type Column } from '../shared/table';
import { quantityName, wordsOf } from '../shared/units';
import type { ParameterSummary, Verdict } from './types';
import { parametersOf, shownModel, shownParameter, type View } from './view';
import { countText, withUnitOf } from './words';

const kRemarks: Record<Verdict, Child> = {
  agrees: null,
  scatter_larger: 'more than the errors',
  scatter_smaller: 'less than the errors',
};

/** "1.03" and its meaning in words. */
function scatterCell({ repeatability }: ParameterSummary): Cell {
  if (!repeatability) return '–';
  const { verdict, texts } = repeatability;
  const remark = kRemarks[verdict];
  return [
    numberText(texts.scatter_ratio),
    remark !== null && el('small', verdict === 'scatter_larger' ? { class: 'no' } : {}, remark),
  ];
}

function row(one: ParameterSummary): Cell[] {
  const { texts, unit } = one;
  return [
    quantityName(one.name, unit),
    countText(one.runs),
    withUnitOf(texts.median, unit),
    numberText(texts.std_dev),
    numberText(texts.median_repeat_error),
    scatterCell(one),
    countText(one.outliers_total),
    numberText(one.trend?.texts.p),
  ];
}

/** Marks the row of the selected parameter. */
function mark(box: HTMLElement, index: number): void {
  box.querySelectorAll('tbody tr').forEach((row, i) => row.classList.toggle('marked', i === index));
}

/** Hides the rows of derived quantities until they are asked for. */
function foldDerived(box: HTMLElement, all: ParameterSummary[]): void {
  const rows = [...box.querySelectorAll<HTMLElement>('tbody tr')].filter((_row, i) => all[i].derived);
  if (rows.length === 0 || rows.length === all.length) return;
  for (const row of rows) row.hidden = true;
  const show = button(`Show ${countText(rows.length)} derived quantities`, () => {
    for (const row of rows) row.hidden = false;
    show.remove();
    box.focus();
  });
  box.append(show);
}

function overview(view: View, all: ParameterSummary[]): HTMLElement {
  const number = 'number' as const;
  const columns: Column[] = [
    { head: 'Parameter' },
    { head: 'Runs', kind: number },
    { head: 'Median', kind: number },
    { head: 'Spread (standard deviation)', kind: number },
    { head: 'Error of repeats (median)', kind: number },
    { head: 'Scatter of one rig ÷ error', kind: number },
    { head: 'Outliers', kind: number },
    { head: 'p of no trend', kind: number },
  ];
  const box = table(`Parameters of ${shownModel(view)?.model}, over its converged fits`, columns, all.map(row));
  box.classList.add('tall', 'names');
  foldDerived(box, all);
  mark(box, all.indexOf(shownParameter(view) as ParameterSummary));
  return box;
}

const kMeaning =
  'The spread is over all runs, of whatever rig. The scatter is that of runs of one rig about their mean, in units of the errors ' +
  'that can make them differ (noise, inconstancy, own clock or calibration): 1 where these errors are right.';

/** `changed` is called after another parameter was selected. */
export function parametersSection(view: View, changed: () => void): HTMLElement {
  const all = parametersOf(view);
  const title = 'The parameters';
  if (all.length === 0)
    return section('parameters', title, absent('No fit of this model converged, so there are no values.'));
  const options = all.map(({ name }) => ({ value: name, label: wordsOf(name) }));
  const box = overview(view, all);
  const chooser = select('Parameter shown', options, shownParameter(view)?.name ?? '', (name) => {
    view.parameter = name;
    mark(
      box,
      all.findIndex((one) => one.name === name),
    );
    changed();
  });
  chooser.classList.add('shown');
  return section('parameters', title, box, text(kMeaning, 'quiet'), chooser);
}
