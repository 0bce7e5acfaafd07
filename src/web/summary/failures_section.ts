// SPDX-License-Identifier: Apache-2.0
/** Fits without a result, by reason. */

import { details, el, text, type Child } from '../shared/dom';
import { identifier, visible } from '../shared/names';
import { typeset } from '../shared/prose';
import { section } from '../shared/section';
import type { Failure, Summary } from './types';
import { counted } from './words';

const kOpen = 20; // reasons that are not collapsed
const kExamples = 3;

/** "run_17, run_21 and 8 more" as elements. */
function names(ids: string[]): Child[] {
  return ids.flatMap((id, i): Child[] => [i > 0 && ', ', identifier(id)]);
}

function examples({ examples: ids, fits }: Failure): HTMLElement | null {
  if (ids.length === 0) return null;
  const label = ids.length < fits ? 'for example ' : '';
  if (ids.length <= kExamples) return el('p', { class: 'quiet' }, label, ...names(ids));
  const rest = (): HTMLElement => el('p', { class: 'quiet' }, ...names(ids));
  return el(
    'div',
    {},
    el('p', { class: 'quiet' }, label, ...names(ids.slice(0, kExamples)), ' …'),
    details(`${ids.length} of the runs`, rest),
  );
}

function item(failure: Failure): HTMLElement {
  const { status, exit_code: code, reason, fits, models } = failure;
  const facts = [models.join(', '), code !== null ? `exit code ${code}` : ''].filter((part) => part !== '');
  return el(
    'li',
    {},
    el(
      'p',
      { class: 'reason' },
      el('strong', {}, `${counted(fits, 'fit')} ${status.replace(/_/g, ' ')}:`),
      ` ${typeset(visible(reason)) || 'no reason was given'}`,
    ),
    el('p', { class: 'quiet' }, facts.join(' · ')),
    examples(failure),
  );
}

const list = (failures: Failure[]): HTMLElement => el('ul', { class: 'failures' }, ...failures.map(item));

export function failuresSection({ summary }: { summary: Summary }): HTMLElement {
  const sorted = [...summary.failures].sort((a, b) => b.fits - a.fits);
  const title = 'Fits without a result';
  if (sorted.length === 0) return section('failures', title, text('Every fit gave a result.'));
  const rest = sorted.slice(kOpen);
  return section(
    'failures',
    title,
    list(sorted.slice(0, kOpen)),
    rest.length > 0 &&
      details(
        `${counted(rest.length, 'more reason')}, of ${counted(
          rest.reduce((sum, { fits }) => sum + fits, 0),
          'fit',
        )}`,
        () => list(rest),
      ),
  );
}
