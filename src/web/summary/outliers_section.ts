// SPDX-License-Identifier: Apache-2.0
/** Outliers: runs whose value is far from the others. */

import { text } from '../shared/dom';
import { identifier, visible } from '../shared/names';
import { numberText } from '../shared/prose';
import { fixed } from '../shared/rounding';
import { section } from '../shared/section';
import { table, type Cell, type Column } from '../shared/table';
import { unitText, wordsOf } from '../shared/units';
import type { ParameterSummary, Summary } from './types';
import { countText, counted } from './words';

const kNamed = 10;

/** The recordings that disagree with the others of their pendulum in all parameters together, as a joint fit finds. */
export function disagreementText({ agreement }: Summary): string {
  if (!agreement) return '';
  const found = agreement.rows.flatMap(({ outliers }) => outliers);
  if (found.length === 0) return '';
  const named = found.slice(0, kNamed).map(({ id, parameter, z }) => {
    const distance = z === null ? '' : `, ${fixed(Math.abs(z), 1)} standard errors`;
    return `${visible(id)} (${wordsOf(parameter)}${distance})`;
  });
  const more = found.length > kNamed ? `, and ${countText(found.length - kNamed)} more` : '';
  const verb = found.length === 1 ? 'recording disagrees' : 'recordings disagree';
  return `${countText(found.length)} ${verb} with the others of the same pendulum in all parameters together, under ${agreement.model}: ${named.join(', ')}${more}.`;
}

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
    run.z === null ? '–' : fixed(run.z, 1),
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
    text('z: how many standard errors a run is from the others of its group.', 'quiet'),
  );
}
