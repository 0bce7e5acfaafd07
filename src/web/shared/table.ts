// SPDX-License-Identifier: Apache-2.0
import { el, type Child } from './dom';

export interface Column {
  head: Child;
  /** "number" is aligned right, with digits of equal width. */
  kind?: 'text' | 'number';
}

export type Cell = Child | Child[];

const children = (cell: Cell): Child[] => (Array.isArray(cell) ? cell : [cell]);

/** A row. Its first cell is a heading. */
function row(cells: Cell[], columns: Column[]): HTMLTableRowElement {
  const element = el('tr');
  cells.forEach((cell, i) => {
    const style: Record<string, string> = columns[i].kind === 'number' ? { class: 'number' } : {};
    element.append(i === 0 ? el('th', { scope: 'row' }, ...children(cell)) : el('td', style, ...children(cell)));
  });
  return element;
}

/** A table with caption and headings, in a box that scrolls horizontally on a narrow page. */
export function table(caption: string, columns: Column[], rows: Cell[][], marked: number[] = []): HTMLElement {
  const head = el('tr');
  for (const column of columns) {
    head.append(el('th', { scope: 'col', ...(column.kind === 'number' ? { class: 'number' } : {}) }, column.head));
  }
  const body = el('tbody');
  rows.forEach((cells, i) => {
    const element = row(cells, columns);
    if (marked.includes(i)) element.classList.add('marked');
    body.append(element);
  });
  return scrollBox(caption, el('table', {}, el('caption', {}, caption), el('thead', {}, head), body));
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
