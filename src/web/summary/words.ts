// SPDX-License-Identifier: Apache-2.0
/** Formats numbers of a summary. */

import type { Num } from '../shared/result_types';
import { errorText, fixed, pdgRounding, rounded, significant } from '../shared/rounding';
import { spacedUnit } from '../shared/units';

const kThinSpace = '\u202f';

/** "100 000"; up to four digits without a space. */
export function countText(count: number): string {
  return count < 10_000 ? String(count) : String(count).replace(/\B(?=(\d{3})+$)/g, kThinSpace);
}

/** "1 run", "100 000 runs". */
export const counted = (count: number, one: string): string => `${countText(count)} ${one}${count === 1 ? '' : 's'}`;

/** "99.9 %". 0 % and 100 % mean exactly none and all. */
export function shareText(count: number, total: number): string {
  if (total === 0) return '–';
  if (count === 0 || count === total) return count === 0 ? '0 %' : '100 %';
  const percent = (100 * count) / total;
  if (percent < 0.1) return '< 0.1 %';
  return `${Math.min(99.9, percent).toFixed(1)} %`;
}

/** A value with the decimals of its error or spread; with six digits if there is none. */
export function valueTo(value: Num, error: Num, unit = ''): string {
  if (value === null) return '–';
  const text = error !== null && error > 0 ? rounded(value, pdgRounding(value, error)) : significant(value, 6);
  return text + spacedUnit(unit);
}

/** A spread or an error, rounded like an error. */
export const spreadText = (spread: Num, unit = ''): string =>
  spread === null ? '–' : errorText(spread, null, null) + spacedUnit(unit);

/** Ratio of scatter to error bars: "1.03", "12.4". */
export function ratioText(ratio: Num): string {
  if (ratio === null) return '–';
  return ratio < 99.95 ? fixed(ratio, ratio < 9.995 ? 2 : 1) : significant(ratio, 3);
}
