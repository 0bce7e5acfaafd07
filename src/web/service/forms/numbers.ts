// SPDX-License-Identifier: Apache-2.0
/** Parses typed and pasted numbers. */

/** The number in a text, with a decimal point or comma; NaN if the text is not a number. */
export function numberFrom(words: string): number {
  const plain = words
    .trim()
    .replace(/[\u2212\u2013]/g, '-')
    .replace(/[\u00a0\u202f ]/g, '');
  const pointed = /^[^.,]*,[^.,]*$/.test(plain) ? plain.replace(',', '.') : plain;
  return /^[-+]?(\d+\.?\d*|\.\d+)(e[-+]?\d+)?$/i.test(pointed) ? Number(pointed) : NaN;
}

/** Cells of one line, separated by tabs, else by semicolons, else by spaces, else by commas. */
function cells(line: string): string[] {
  for (const separator of ['\t', ';']) if (line.includes(separator)) return line.split(separator);
  const words = line.trim().split(/\s+/);
  const spaced = words.length > 1 && !words[0].endsWith(',') && !words[1].startsWith(',');
  return spaced ? words : line.split(',');
}

/** The first two columns of pasted text. A line whose first two cells are not numbers is a heading and is skipped. */
export function pastedRows(pasted: string): [string, string][] {
  const rows: [string, string][] = [];
  for (const line of pasted.split(/\r\n|\n|\r/)) {
    const [reading = '', angle = ''] = cells(line).map((cell) => cell.trim().replace(/^"(.*)"$/, '$1'));
    const told = [reading, angle].map((cell) => Number.isFinite(numberFrom(cell)));
    if (told[0] || told[1]) rows.push([reading, angle]);
  }
  return rows;
}

/** Whether the text is for several cells: it has more than one line, or more than one number. */
export const isTable = (pasted: string): boolean => {
  const rows = pastedRows(pasted);
  return rows.length > 1 || (rows.length === 1 && rows[0][1] !== '');
};
