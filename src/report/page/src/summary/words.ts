// SPDX-License-Identifier: Apache-2.0
/** Numbers and names of a summary for the eye. */

import { el } from '../dom';
import { errorText, fixed, pdgRounding, rounded, significant } from '../rounding';
import type { Num } from '../types';
import { spacedUnit } from '../units';

const kThinSpace = '\u202f';

/** "100 000"; four digits stay together. */
export function countText(count: number): string {
  return count < 10_000 ? String(count) : String(count).replace(/\B(?=(\d{3})+$)/g, kThinSpace);
}

/** "1 run", "100 000 runs". */
export const counted = (count: number, one: string): string => `${countText(count)} ${one}${count === 1 ? '' : 's'}`;

/** "99.9 %": all and none are said only of all and none. */
export function shareText(count: number, total: number): string {
  if (total === 0) return '–';
  if (count === 0 || count === total) return count === 0 ? '0 %' : '100 %';
  const percent = (100 * count) / total;
  if (percent < 0.1) return '< 0.1 %';
  return `${Math.min(99.9, percent).toFixed(1)} %`;
}

/** A value to the decimals of an error or a spread; to six digits without. */
export function valueTo(value: Num, error: Num, unit = ''): string {
  if (value === null) return '–';
  const text = error !== null && error > 0 ? rounded(value, pdgRounding(value, error)) : significant(value, 6);
  return text + spacedUnit(unit);
}

/** A spread or an error, to the digits of an error. */
export const spreadText = (spread: Num, unit = ''): string =>
  spread === null ? '–' : errorText(spread, null, null) + spacedUnit(unit);

const kEscapes: Record<string, string> = { '\n': '\\n', '\r': '\\r', '\t': '\\t' };
const kUnseen = /[\u0000-\u001f\u007f-\u009f\u200b-\u200f\u2028-\u202e\u2066-\u2069\ufeff]/g;

/** Control characters, and those that turn the direction of writing, as escapes that are seen. */
export function visible(name: string): string {
  return name.replace(kUnseen, (c) => kEscapes[c] ?? `\\u${c.charCodeAt(0).toString(16).padStart(4, '0')}`);
}

/** Scatter over error bars: "1.03", "12.4". */
export function ratioText(ratio: Num): string {
  if (ratio === null) return '–';
  return ratio < 99.95 ? fixed(ratio, ratio < 9.995 ? 2 : 1) : significant(ratio, 3);
}

/** The name of a run or a group, which may be anything. */
export const identifier = (name: string): HTMLElement => el('bdi', { class: 'id' }, visible(name));

/** A name of at most so many characters, its middle left out. */
export function elided(name: string, most: number): string {
  const characters = [...visible(name)];
  if (characters.length <= most) return characters.join('');
  const end = Math.floor((most - 1) / 2);
  return `${characters.slice(0, most - 1 - end).join('')}…${characters.slice(-end).join('')}`;
}
