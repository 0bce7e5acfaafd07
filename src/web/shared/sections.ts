// SPDX-License-Identifier: Apache-2.0
/** The sections of a report as the program words them (report/sections_json.h): the page shows the same texts and digits. */

import { el, symbolElement, type Child } from './dom';
import { capital, prose, typeset } from './prose';
import { facts, table, type Cell } from './table';
import { wordsOf } from './units';

type Emphasis = 'none' | 'caution' | 'alarm';

export interface TableBlock {
  kind: 'table';
  /** `joins`: the cells belong to those of the column before, as an error to its value. */
  columns: { header: string; is_number: boolean; joins: boolean }[];
  rows: string[][];
  /** A cell of this text is emphasized. */
  caution: string | null;
  /** Says after this number of rows what the table leaves out. */
  rows_before: number;
  left_out: string | null;
}

export type Block =
  | { kind: 'words'; text: string; emphasis: Emphasis }
  | { kind: 'facts'; rows: { name: string; text: string; emphasis: Emphasis }[] }
  | TableBlock
  | { kind: 'formula'; text: string }
  | { kind: 'items'; texts: string[]; emphasis: Emphasis };

export interface ReportSection {
  id: string;
  title: string;
  /** Null: about all. */
  law: string | null;
  /** From 1; null: about all. */
  recording: number | null;
  remark: string | null;
  blocks: Block[];
}

/** What the page adds to the rows of a table, by the text of their first cells. */
export interface RowLook {
  head?: (text: string) => Child[];
  marked?: (text: string) => boolean;
}

const emphasized = (emphasis: Emphasis): Record<string, string> => (emphasis === 'none' ? {} : { class: emphasis });

/** Begins with a capital letter, unless it begins with a name or a short symbol. */
const capitalized = (text: string): string => (/^(?!rms|th )[a-z]{2,}($|[ ,])/.test(text) ? capital(text) : text);

const kNames = ['', 'name', 'quantity', 'parameter'];

/** "release angle release_angle": a name of the JSON in words; also several names. Other texts as they are. */
function nameCell(text: string): Child[] {
  if (!/^[a-z_]+(, [a-z_]+)*$/.test(text)) return prose(text);
  const words = text.split(', ').map((name) => wordsOf(name).replace(/_/g, ' ')).join(', ');
  return wordsOf(text) === text ? [words] : [words, ' ', el('code', {}, text)];
}

/** The columns with content, as [first, end) of those they join. A drawing in text is none: the page has a plot. */
function joinedColumns({ columns, rows }: TableBlock): [number, number][] {
  const starts = columns.flatMap(({ joins }, i) => (joins ? [] : [i]));
  return starts
    .map((from, k): [number, number] => [from, starts[k + 1] ?? columns.length])
    .filter(([from]) => rows.some((row) => row[from] !== '' && (columns[from].header !== '' || /[^\s*<>|-]/.test(row[from]))));
}

/** A row that only repeats values in another unit, such as degrees, is part of the row before. */
function groupedRows({ rows }: TableBlock): string[][][] {
  const groups: string[][][] = [];
  for (const row of rows) {
    const before = groups[groups.length - 1];
    const filled = row.findIndex((cell) => cell !== '');
    if (before && filled > 0 && /^[±\d[-]/.test(row[filled])) before.push(row);
    else groups.push([before && row[0] === '' ? [before[0][0], ...row.slice(1)] : row]);
  }
  return groups;
}

function tableElement(caption: string, block: TableBlock, look: RowLook): HTMLElement {
  const spans = joinedColumns(block);
  const groups = groupedRows(block);
  const header = (i: number): string => block.columns[i].header;
  const joined = (texts: string[], [from, end]: [number, number]): string =>
    texts.slice(from, end).filter((text) => text !== '').join(' ');
  const content = (text: string, at: number): Child[] => {
    if (at === 0 && look.head) return look.head(text);
    if (header(at) === 'unit' && text === '1') return [];
    if (text === block.caution) return [el('strong', { class: 'no' }, ...prose(text))];
    if (header(at) === 'symbol' && text !== '') return [symbolElement(text)];
    return at < 2 && kNames.includes(header(at)) ? nameCell(text) : prose(text);
  };
  const cell = (group: string[][], span: [number, number]): Cell => {
    const [first, ...others] = group.map((row) => joined(row, span));
    const more = others.filter((text) => text !== '').map((text) => el('small', {}, ...prose(text)));
    const told = content(first, span[0]);
    return [told.length > 0 && first !== '' && el('span', {}, ...told), ...more];
  };
  const columns = spans.map((span) => ({
    head: el('span', {}, ...prose(capitalized(joined(block.columns.map((column) => column.header), span)))),
    kind: block.columns[span[0]].is_number ? ('number' as const) : ('text' as const),
  }));
  const marked = groups.flatMap(([[text]], i) => (look.marked?.(text) ? [i] : []));
  const element = table(caption, columns, groups.map((group) => spans.map((span) => cell(group, span))), marked);
  element.querySelector('caption')?.classList.add('unseen'); // the heading above says it
  if (block.left_out !== null) {
    const words = el('td', { colspan: String(spans.length), class: 'left-out' }, ...prose(block.left_out));
    const body = element.querySelector('tbody')!;
    body.insertBefore(el('tr', { role: 'row' }, words), body.rows[block.rows_before] ?? null);
  }
  return element;
}

/** `caption`: of a table, for screen readers. */
export function blockElement(block: Block, caption: string, look: RowLook = {}): HTMLElement {
  if (block.kind === 'words') return el('p', emphasized(block.emphasis), ...prose(capitalized(block.text)));
  if (block.kind === 'formula') return el('p', { class: 'equation' }, ...prose(block.text));
  if (block.kind === 'table') return tableElement(caption, block, look);
  if (block.kind === 'facts') {
    const list = facts(block.rows.map(({ name, text, emphasis }) => [typeset(name), el('span', emphasized(emphasis), ...prose(text))]));
    list.classList.add('lines');
    return list;
  }
  const items = block.texts.map((text) => el('li', {}, ...prose(capitalized(text))));
  return el('ul', block.emphasis === 'none' ? {} : { class: 'warnings' }, ...items);
}

/** Captions of the tables: each is different, also from the heading, so that screen readers can tell them apart. */
export const captionOf = (section: ReportSection, k: number): string =>
  `${section.title}: table${k === 0 ? '' : ` ${k + 1}`}`;

export const blockElements = (section: ReportSection, look: RowLook = {}): HTMLElement[] =>
  section.blocks
    .filter((block) => block.kind !== 'table' || block.rows.length > 0)
    .map((block, k) => blockElement(block, captionOf(section, k), look));
