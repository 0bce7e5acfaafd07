// SPDX-License-Identifier: Apache-2.0
/** Typesets sentences of the JSON: "4.1e-26 kg m^2" becomes "4.1 × 10⁻²⁶ kg m²". */

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

const raised = (digits: string): string => [...digits].map((digit) => kSuperscript[digit] ?? '').join('');

let worded = (words: string): string => words;

/** From now on applies `change` to all sentences of the JSON: the page of the service has no command-line flags. */
export const wordWith = (change: (words: string) => string): void => void (worded = change);

/** Applies the change of wordWith() and turns powers into superscripts. */
export function typeset(words: string): string {
  return worded(words)
    .replace(
      /([\d)])e([-+]?)0*(\d+)\b/g,
      (_all, digit: string, sign: string, power: string) =>
        `${digit} × 10${raised(sign === '-' ? `-${power}` : power)}`,
    )
    .replace(/\bsigma\^/g, 'σ^')
    .replace(/\bchi2\b/g, 'χ²')
    .replace(/\^(-?\d+)/g, (_all, power: string) => raised(power));
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
