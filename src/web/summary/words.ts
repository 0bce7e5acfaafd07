// SPDX-License-Identifier: Apache-2.0
/** Formats numbers of a summary. */

import { numberText } from '../shared/prose';
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

/** A number of the JSON with its unit. */
export const withUnitOf = (text: string, unit: string): string =>
  text === '-' ? numberText(text) : numberText(text) + spacedUnit(unit);
