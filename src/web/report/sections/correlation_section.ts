// SPDX-License-Identifier: Apache-2.0
import { el } from '../../shared/dom';
import { absent, section } from '../../shared/section';
import { contourPart, type Pair } from '../contours';
import { shownFit, type Report } from '../report';
import { sectionsOf, told } from '../told';

/** The pair in the first row of the table, which is the strongest one. */
function strongest(report: Report, [first, second]: string[]): Pair {
  const [table] = sectionsOf(report, 'correlation').flatMap((one) => one.blocks.filter((block) => block.kind === 'table'));
  const [x, y] = table?.rows[0]?.[0].split(', ') ?? [];
  return y === undefined ? [first, second] : [x, y];
}

export function correlationSection(report: Report): HTMLElement {
  const fit = shownFit(report);
  const title = 'Correlations';
  const names = fit?.correlation.names ?? [];
  if (!fit || names.length < 2) {
    const why = 'Fewer than two parameters have standard errors, so there are no correlations.';
    return section('correlation', title, absent(why));
  }
  const words = told(report, 'correlation', title);
  return section('correlation', title, el('div', { class: 'pair' }, ...words, contourPart(fit, names, strongest(report, names))));
}
