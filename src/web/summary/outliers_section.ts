// SPDX-License-Identifier: Apache-2.0
/** Outliers: runs whose value is far from the others. */

import { text } from '../shared/dom';
import { identifier, visible } from '../shared/names';
import { numberText, sentence } from '../shared/prose';
import { section } from '../shared/section';
import { table, type Cell, type Column } from '../shared/table';
import { unitText } from '../shared/units';
import type { ParameterSummary, Summary } from './types';
import { countText, counted } from './words';

/** The recordings that disagree with the others of their pendulum, as the program says it. */
export const disagreementText = ({ disagreement }: Summary): string => sentence(visible(disagreement ?? ''));

export function outliersSection(one: ParameterSummary, summary: Summary): HTMLElement {
  const title = 'Outliers';
  const { group_by: group } = summary;
  const { outliers, outliers_total: total } = one;
  const disagreement = disagreementText(summary);
  const joint = disagreement !== '' && text(disagreement);
  if (total === 0) return section('outliers', title, joint, text('No recording is far from the others in this parameter.'));
  const unit = unitText(one.unit);
  const grouped = group !== null || outliers.some((run) => run.group !== null);
  const columns: Column[] = [
    { head: 'Run' },
    ...(grouped ? [{ head: visible(group ?? 'Group') }] : []),
    { head: `Value ± standard error${unit && ` [${unit}]`}`, kind: 'number' },
    { head: 'z', kind: 'number' },
  ];
  const rows = outliers.map((run): Cell[] => [
    identifier(run.id),
    ...(grouped ? [run.group === null ? '–' : identifier(run.group)] : []),
    numberText(run.text),
    numberText(run.z_text),
  ]);
  const count =
    total > outliers.length ? `The ${outliers.length} furthest of ${countText(total)} runs` : counted(total, 'run');
  const box = table(`${count} far from the others`, columns, rows);
  box.classList.add('ids', 'tall');
  return section(
    'outliers',
    title,
    joint,
    box,
    text(
      'z: the distance of a run from the median of its group, over the scatter of the group or the standard error of the run, whichever is larger.',
      'quiet',
    ),
  );
}
