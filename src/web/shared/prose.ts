// SPDX-License-Identifier: Apache-2.0
/** Typesets sentences of the JSON: "-4.1e-26 kg m^2" becomes "−4.1 × 10⁻²⁶ kg m²". */

import { el, symbolElement, type Child } from './dom';

const kSuperscript: Record<string, string> = {
  '-': '⁻',
  '0': '⁰',
  '1': '¹',
  '2': '²',
  '3': '³',
  '4': '⁴',
  '5': '⁵',
  '6': '⁶',
  '7': '⁷',
  '8': '⁸',
  '9': '⁹',
};

/** "⁻²" for "-2". */
export const raised = (digits: string): string => [...digits].map((digit) => kSuperscript[digit] ?? '').join('');

let worded = (words: string): string => words;

/** From now on applies `change` to all sentences of the JSON: the page of the service has no command-line flags. */
export const wordWith = (change: (words: string) => string): void => void (worded = change);

/** Applies the change of wordWith(), and writes powers and minus signs as print does. */
export function typeset(words: string): string {
  return worded(words)
    .replace(
      /([\d)])e([-+]?)0*(\d+)\b/g,
      (_all, digit: string, sign: string, power: string) =>
        `${digit} × 10${raised(sign === '-' ? `-${power}` : power)}`,
    )
    .replace(/\bsigma\^/g, 'σ^')
    .replace(/\bchi2\b/g, 'χ²')
    .replace(/\^(-?\d+)/g, (_all, power: string) => raised(power))
    .replace(/(?<![\p{L}\d_.)\]⁻-])-(?=\d)/gu, '−');
}

/** A number as the program writes it, as print does; "–" if there is none. */
export const numberText = (text: string | null | undefined): string =>
  text === null || text === undefined || text === '-' ? '–' : typeset(text);

/** "θ″" for "th''": the angle in an equation. */
export const withTheta = (words: string): string =>
  words.replace(/\bth''/g, 'θ″').replace(/\bth'/g, 'θ′').replace(/\bth\b/g, 'θ').replace(/ - (?=[\d.\p{L}])/gu, ' − ');

// A symbol such as I_O/G, or a name of the JSON such as release_angle; not a part of a path, a flag or a quoted word.
const kSymbol = /(?<![\p{L}\d_/"'.-])(\p{L}_\p{L}{1,3}(?:\/\p{L}(?:_\p{L})?)?|[a-z]+(?:_[a-z]+)+)(?![\p{L}\d_"'/-]|\.\p{L})/u;

/** A text of the program with degrees and dashes as in print, symbols in italics and names as code. */
export function prose(words: string): Child[] {
  const plain = typeset(words).replace(/^-$/, '–').replace(/(^|[\d)[]) ?deg\b/g, '$1°');
  const parts = withTheta(plain).split(kSymbol);
  return parts.map((part, i) => (i % 2 === 0 ? part : /^.{1}_/u.test(part) ? symbolElement(part) : el('code', {}, part)));
}

export const capital = (words: string): string => words.slice(0, 1).toUpperCase() + words.slice(1);

/** The words with a capital letter and a full stop. */
export function sentence(words: string): string {
  const trimmed = typeset(words.trim());
  if (trimmed === '') return '';
  return capital(trimmed) + (/[.!?]$/.test(trimmed) ? '' : '.');
}

/** "1, 2 and 3" */
export function inList(items: readonly (string | number)[]): string {
  if (items.length < 2) return items.join('');
  return `${items.slice(0, -1).join(', ')} and ${items[items.length - 1]}`;
}
