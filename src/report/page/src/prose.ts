// SPDX-License-Identifier: Apache-2.0
/** Sentences of the JSON, set for the eye: "4.1e-26 kg m^2" as "4.1 × 10⁻²⁶ kg m²". */

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

/** Says the sentences of the JSON in other words from now on: those of the command line mean nothing on another page. */
export const wordWith = (change: (words: string) => string): void => void (worded = change);

/** Powers as superscripts. Otherwise the words stay as they are, or as they were asked to be. */
export function typeset(words: string): string {
  return worded(words)
    .replace(
      /(\d)e([-+]?)0*(\d+)\b/g,
      (_all, digit: string, sign: string, power: string) =>
        `${digit} × 10${raised(sign === '-' ? `-${power}` : power)}`,
    )
    .replace(/\bsigma\^/g, 'σ^')
    .replace(/\bchi2\b/g, 'χ²')
    .replace(/\^(-?\d+)/g, (_all, power: string) => raised(power));
}

export const capital = (words: string): string => words.slice(0, 1).toUpperCase() + words.slice(1);

/** The words with a capital and a full stop. */
export function sentence(words: string): string {
  const trimmed = typeset(words.trim());
  if (trimmed === '') return '';
  return capital(trimmed) + (/[.!?]$/.test(trimmed) ? '' : '.');
}
