// SPDX-License-Identifier: Apache-2.0
/** Numbers as people type and paste them. */

/** The number of a text with a decimal point or comma; NaN of anything else. */
export function numberFrom(words: string): number {
  const plain = words
    .trim()
    .replace(/[\u2212\u2013]/g, '-')
    .replace(/[\u00a0\u202f ]/g, '');
  const pointed = /^[^.,]*,[^.,]*$/.test(plain) ? plain.replace(',', '.') : plain;
  return /^[-+]?(\d+\.?\d*|\.\d+)(e[-+]?\d+)?$/i.test(pointed) ? Number(pointed) : NaN;
}

/** Cells of one line: apart by tabs, else semicolons, else spaces, else commas. */
function cells(line: string): string[] {
  for (const separator of ['\t', ';']) if (line.includes(separator)) return line.split(separator);
  const words = line.trim().split(/\s+/);
  const spaced = words.length > 1 && !words[0].endsWith(',') && !words[1].startsWith(',');
  return spaced ? words : line.split(',');
}

/** True of two columns or more without a line that names them. */
export function isHeadless(pasted: string): boolean {
  const first = pasted.split(/\r\n|\n|\r/).find((line) => line.trim() !== '' && !line.startsWith('#')) ?? '';
  const [time, value] = cells(first).map((cell) => numberFrom(cell.trim().replace(/^"(.*)"$/, '$1')));
  return Number.isFinite(time) && Number.isFinite(value);
}

/** Two columns of what was pasted; a line whose first two cells are no numbers is a heading and left out. */
export function pastedRows(pasted: string): [string, string][] {
  const rows: [string, string][] = [];
  for (const line of pasted.split(/\r\n|\n|\r/)) {
    const [reading = '', angle = ''] = cells(line).map((cell) => cell.trim().replace(/^"(.*)"$/, '$1'));
    const told = [reading, angle].map((cell) => Number.isFinite(numberFrom(cell)));
    if (told[0] || told[1]) rows.push([reading, angle]);
  }
  return rows;
}

/** True for what belongs into several cells: more than one line, or more than one number. */
export const isTable = (pasted: string): boolean => {
  const rows = pastedRows(pasted);
  return rows.length > 1 || (rows.length === 1 && rows[0][1] !== '');
};
