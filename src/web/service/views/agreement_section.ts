// SPDX-License-Identifier: Apache-2.0
/** Whether the recordings of a batch agree, with the means of their parameters. */

import { banner } from '../../shared/banner';
import { el } from '../../shared/dom';
import { visible } from '../../shared/names';
import { numberText, typeset } from '../../shared/prose';
import { table, type Cell } from '../../shared/table';
import { quantityName, unitText } from '../../shared/units';
import type { BatchAgreement } from '../types';

export function agreementSection({ law, level, text, means }: BatchAgreement): HTMLElement {
  const box = el('div', { class: 'batch-agreement' }, banner({ level, title: typeset(visible(text)), sentence: '' }));
  if (law === null || means.length === 0) return box;
  const rows = means.map(({ name, unit, text: value, recordings }): Cell[] => [
    el('span', {}, ...quantityName(name, unit)),
    [numberText(value), unitText(unit) !== '' && ` ${unitText(unit)}`],
    String(recordings),
  ]);
  const heads = [
    { head: 'Parameter' },
    { head: 'Mean ± total error', kind: 'number' as const },
    { head: 'Recordings', kind: 'number' as const },
  ];
  box.append(table(`Means under the law ${law}`, heads, rows));
  return box;
}
