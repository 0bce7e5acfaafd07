// SPDX-License-Identifier: Apache-2.0
/** Names of files, runs and groups, which may contain any character. */

import { el } from './dom';

/** Name of the file without its folders. */
export const fileName = (path: string | null): string => path?.split(/[\\/]/).pop() || 'recording without a name';

const kEscapes: Record<string, string> = { '\n': '\\n', '\r': '\\r', '\t': '\\t' };
const kUnseen = /[\u0000-\u001f\u007f-\u009f\u200b-\u200f\u2028-\u202e\u2066-\u2069\ufeff]/g;

/** Replaces control characters, and characters that change the writing direction, by visible escapes. */
export function visible(name: string): string {
  return name.replace(kUnseen, (c) => kEscapes[c] ?? `\\u${c.charCodeAt(0).toString(16).padStart(4, '0')}`);
}

/** An element with the name of a run or a group. */
export const identifier = (name: string): HTMLElement => el('bdi', { class: 'id' }, visible(name));

/** The name, shortened in its middle to at most `most` characters. */
export function elided(name: string, most: number): string {
  const characters = [...visible(name)];
  if (characters.length <= most) return characters.join('');
  const end = Math.floor((most - 1) / 2);
  return `${characters.slice(0, most - 1 - end).join('')}…${characters.slice(-end).join('')}`;
}
