// SPDX-License-Identifier: Apache-2.0
/** Comparison of the laws. */

import { modelMark, swatch } from '../../shared/marks';
import { rankOf, type Report } from '../report';
import { toldPart } from '../told';

/** Each law with the mark of its curve. The recommended one is marked. Null if only one law was fitted. */
export function comparisonSection(report: Report): HTMLElement | null {
  const { result } = report;
  const head = (law: string): (Node | string)[] => {
    const i = result.fits.findIndex((fit) => fit.model === law);
    return i < 0 ? [law] : [swatch(modelMark(rankOf(result, i))), law];
  };
  return toldPart(report, 'comparison', 'Comparison', [], { head, marked: (law) => law === result.comparison?.recommended });
}
