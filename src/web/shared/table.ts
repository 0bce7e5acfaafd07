// SPDX-License-Identifier: Apache-2.0
import { el, type Child } from './dom';

export interface Column {
  head: Child;
  /** "number" is aligned right, with digits of equal width. */
  kind?: 'text' | 'number';
}

export type Cell = Child | Child[];

const children = (cell: Cell): Child[] => (Array.isArray(cell) ? cell : [cell]);

/** The heading of a column as text. */
const headText = ({ head }: Column): string =>
  (typeof head === 'string' ? head : head instanceof Node ? head.textContent : null) ?? '';

/** A row. Its first cell is a heading. The other cells have the heading of their column for a narrow page. */
function row(cells: Cell[], columns: Column[]): HTMLTableRowElement {
  const element = el('tr', { role: 'row' });
  cells.forEach((cell, i) => {
    const style: Record<string, string> = columns[i].kind === 'number' ? { class: 'number' } : {};
    Object.assign(style, { role: 'cell', 'data-head': headText(columns[i]) });
    element.append(i === 0 ? el('th', { scope: 'row', role: 'rowheader' }, ...children(cell)) : el('td', style, ...children(cell)));
  });
  return element;
}

const kFewColumns = 2;

/**
 * A table with caption and headings. On a narrow page each row of a table of more than two columns becomes a list of its
 * cells; a table of two columns, or of many rows in a fold, scrolls. The roles keep it a table for screen readers.
 */
export function table(caption: string, columns: Column[], rows: Cell[][], marked: number[] = []): HTMLElement {
  const head = el('tr', { role: 'row' });
  for (const column of columns) {
    const kind: Record<string, string> = column.kind === 'number' ? { class: 'number' } : {};
    const named = headText(column) !== '';
    head.append(named ? el('th', { scope: 'col', role: 'columnheader', ...kind }, column.head) : el('td', { role: 'cell' }));
  }
  const body = el('tbody', { role: 'rowgroup' });
  rows.forEach((cells, i) => {
    const element = row(cells, columns);
    if (marked.includes(i)) element.classList.add('marked');
    body.append(element);
  });
  const kind: Record<string, string> = columns.length > kFewColumns ? { class: 'rows' } : {};
  const heads = columns.some((column) => headText(column) !== '') && el('thead', { role: 'rowgroup' }, head);
  return scrollBox(caption, el('table', { role: 'table', ...kind }, el('caption', {}, caption), heads, body));
}

/** A box that scrolls horizontally, also by keyboard. */
export function scrollBox(label: string, content: HTMLElement): HTMLElement {
  return el('div', { class: 'scroll', tabindex: '0', role: 'region', 'aria-label': label }, content);
}

/** A list of names and values. */
export function facts(rows: [string, Cell][]): HTMLElement {
  const list = el('dl', { class: 'facts' });
  for (const [name, value] of rows) list.append(el('div', {}, el('dt', {}, name), el('dd', {}, ...children(value))));
  return list;
}
