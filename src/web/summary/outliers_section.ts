// SPDX-License-Identifier: Apache-2.0
/** Outliers: runs whose value is far from the others. */

import { text } from '../shared/dom';
import { identifier, visible } from '../shared/names';
import { fixed, plusMinus } from '../shared/rounding';
import { section } from '../shared/section';
import { table, type Cell, type Column } from '../shared/table';
import { unitText } from '../shared/units';
import type { ParameterSummary } from './types';
import { countText, counted } from './words';

export function outliersSection(one: ParameterSummary, group: string | null): HTMLElement {
  const title = 'Outliers';
  const { outliers, outliers_total: total } = one;
  if (total === 0) return section('outliers', title, text('No run is far from the others.'));
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
    plusMinus(run.estimate, run.std_error),
    run.z === null ? '–' : fixed(run.z, 1),
  ]);
  const count =
    total > outliers.length ? `The ${outliers.length} furthest of ${countText(total)} runs` : counted(total, 'run');
  const box = table(`${count} far from the others`, columns, rows);
  box.classList.add('ids', 'tall');
  return section(
    'outliers',
    title,
    box,
    text('z: how many standard errors a run is from the others of its group.', 'quiet'),
  );
}
