// SPDX-License-Identifier: Apache-2.0
import { el } from './dom';

const two = (count: number): string => String(count).padStart(2, '0');

/** "2026-12-01 07:03" or "2026-12-01 07:03:09": an instant (RFC 3339) in the time zone of the reader; or the text itself. */
export function localTimeText(instant: string, isToTheSecond = false): string {
  const at = new Date(instant);
  if (Number.isNaN(at.getTime())) return instant;
  const day = [at.getFullYear(), two(at.getMonth() + 1), two(at.getDate())].join('-');
  const time = [at.getHours(), at.getMinutes(), ...(isToTheSecond ? [at.getSeconds()] : [])];
  return `${day} ${time.map(two).join(':')}`;
}

/** The same as an element, which keeps the instant. */
export const localTime = (instant: string, isToTheSecond = false): HTMLElement =>
  el('time', { datetime: instant }, localTimeText(instant, isToTheSecond));
