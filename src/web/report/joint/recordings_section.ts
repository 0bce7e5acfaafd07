// SPDX-License-Identifier: Apache-2.0
/** Tables of the recordings of a joint fit and of their own parameters. */

import { el } from '../../shared/dom';
import { recordingMark, swatch } from '../../shared/marks';
import { shownFit, type Report } from '../report';
import { toldPart } from '../told';

/** Each recording has its colour in the plots, and the word whether it disagrees. */
export function recordingsSection(report: Report): HTMLElement | null {
  const outliers = shownFit(report)?.homogeneity?.outliers ?? [];
  const head = (number: string): (Node | string)[] => [
    swatch(recordingMark(Number(number) - 1)),
    number,
    ...(outliers.includes(Number(number)) ? [el('small', { class: 'no' }, 'disagrees')] : []),
  ];
  return toldPart(report, 'recordings', 'Recordings', [], { head });
}
