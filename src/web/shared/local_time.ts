// SPDX-License-Identifier: Apache-2.0
import { el } from './dom';

const two = (count: number): string => String(count).padStart(2, '0');

/** "2026-12-01 07:03": an instant (RFC 3339) in the time zone of the reader; the text itself if it is none. */
export function localTimeText(instant: string): string {
  const at = new Date(instant);
  if (Number.isNaN(at.getTime())) return instant;
  const day = [at.getFullYear(), two(at.getMonth() + 1), two(at.getDate())].join('-');
  return `${day} ${two(at.getHours())}:${two(at.getMinutes())}`;
}

/** The same as an element, which keeps the instant. */
export const localTime = (instant: string): HTMLElement => el('time', { datetime: instant }, localTimeText(instant));
