// SPDX-License-Identifier: Apache-2.0
/** How the fits of each model ended, and how often each model was recommended. */

import { el, text } from '../shared/dom';
import { absent, section } from '../shared/section';
import { table, type Cell, type Column } from '../shared/table';
import { barList } from './bars';
import type { ModelCounts, Summary } from './types';
import { countText, shareText } from './words';

type Status = 'converged' | 'not_converged' | 'not_identifiable' | 'failed';

const kStatuses: [Status, string][] = [
  ['converged', 'Converged'],
  ['not_converged', 'Not converged'],
  ['not_identifiable', 'Not identifiable'],
  ['failed', 'Failed'],
];

const cell = (count: number, total: number): Cell =>
  count === 0 ? '0' : [countText(count), el('small', {}, shareText(count, total))];

const row = (counts: ModelCounts): Cell[] => [
  counts.model,
  countText(counts.fits),
  ...kStatuses.map(([status]) => cell(counts[status], counts.fits)),
];

function statusTable(models: ModelCounts[]): HTMLElement {
  const columns: Column[] = [
    { head: 'Model' },
    { head: 'Fits', kind: 'number' },
    ...kStatuses.map(([, head]): Column => ({ head, kind: 'number' })),
  ];
  return table('How the fits ended', columns, models.map(row));
}

/** Null if no run compared models. */
function recommendations({ recommendations: list }: Summary): HTMLElement[] {
  if (list.length === 0) return [text('No run compared models, so none was recommended.', 'quiet')];
  const total = list.reduce((sum, { runs }) => sum + runs, 0);
  const rows = [...list]
    .sort((a, b) => b.runs - a.runs)
    .map(({ model, runs }) => ({ name: model ?? el('span', { class: 'quiet' }, 'none'), count: runs }));
  return [
    el('h3', {}, 'Recommended by the comparison of models, runs'),
    barList('Runs by the model recommended', rows, total),
  ];
}

export function modelsSection({ summary }: { summary: Summary }): HTMLElement {
  return section(
    'models',
    'Models',
    summary.models.length > 0 ? statusTable(summary.models) : absent('No model was fitted.'),
    ...(summary.models.length > 0 ? recommendations(summary) : []),
  );
}
