// SPDX-License-Identifier: Apache-2.0
/** A table for readings and angles, to be typed or pasted. */

import { button, el } from '../../shared/dom';
import { isTable, numberFrom, pastedRows } from '../forms/numbers';
import { unmark } from '../forms/problem_fields';
import { FieldError } from '../server/problem';

const kFirstRows = 5;

interface Row {
  element: HTMLTableRowElement;
  inputs: [HTMLInputElement, HTMLInputElement];
}

export class CalibrationTable {
  readonly element: HTMLElement;
  private rows: Row[] = [];
  private readonly body = el('tbody');
  private readonly heads = [el('th', { scope: 'col' }), el('th', { scope: 'col' })];

  constructor() {
    const head = el('tr', {}, el('th', { scope: 'col' }, 'Row'), ...this.heads, el('td'));
    const caption = el('caption', {}, 'Readings at known angles');
    const grid = el('table', { class: 'entry' }, caption, el('thead', {}, head), this.body);
    const add = button('Add a row', () => this.add().inputs[0].focus());
    this.element = el('div', {}, grid, add);
    this.name('counts', 'degrees');
    this.body.addEventListener('input', () => this.unmark());
    for (let i = 0; i < kFirstRows; ++i) this.add();
  }

  /** Units of the columns. */
  name(reading: string, angle: string): void {
    this.heads[0].textContent = `Reading [${reading}]`;
    this.heads[1].textContent = `Angle [${angle}]`;
  }

  private input(what: string, column: 0 | 1): HTMLInputElement {
    const input = el('input', { type: 'text', inputmode: 'decimal', autocomplete: 'off' });
    input.dataset.what = what;
    input.addEventListener('paste', (event) => {
      const pasted = event.clipboardData?.getData('text') ?? '';
      if (!isTable(pasted)) return;
      event.preventDefault();
      this.paste(pasted, input, column);
    });
    return input;
  }

  private add(): Row {
    const inputs: Row['inputs'] = [this.input('Reading', 0), this.input('Angle', 1)];
    const remove = button('✕', () => this.remove(row), { class: 'remove' });
    const element = el(
      'tr',
      {},
      el('th', { scope: 'row' }),
      ...inputs.map((input) => el('td', {}, input)),
      el('td', {}, remove),
    );
    const row = { element, inputs };
    this.rows.push(row);
    this.body.append(element);
    this.number();
    return row;
  }

  private remove(row: Row): void {
    const i = this.rows.indexOf(row);
    this.rows.splice(i, 1);
    this.unmark();
    row.element.remove();
    if (this.rows.length === 0) this.add();
    this.number();
    this.rows[Math.min(i, this.rows.length - 1)].inputs[0].focus();
  }

  /** Removes the error marks after any cell has changed. */
  private unmark(): void {
    for (const { inputs } of this.rows) inputs.forEach(unmark);
  }

  /** Numbers the rows from 1, also in the labels for screen readers. */
  private number(): void {
    this.rows.forEach(({ element, inputs }, i) => {
      element.firstElementChild!.textContent = String(i + 1);
      for (const input of inputs) input.setAttribute('aria-label', `${input.dataset.what}, row ${i + 1}`);
      element.querySelector('button')?.setAttribute('aria-label', `Remove row ${i + 1}`);
    });
  }

  /** Fills rows, beginning with that of the input. A single pasted column goes into the column of the input. */
  private paste(pasted: string, input: HTMLInputElement, column: 0 | 1): void {
    this.unmark();
    let i = this.rows.findIndex(({ inputs }) => inputs.includes(input));
    for (const [first, second] of pastedRows(pasted)) {
      const { inputs } = this.rows[i++] ?? this.add();
      if (second === '') inputs[column].value = first;
      else [inputs[0].value, inputs[1].value] = [first, second];
    }
    (this.rows[i] ?? this.add()).inputs[column].focus();
  }

  /** Shows these rows and one more. */
  fill(rows: readonly (readonly [number, number])[]): void {
    this.unmark();
    while (this.rows.length < rows.length) this.add();
    this.rows.forEach(({ inputs }, i) => inputs.forEach((input, k) => (input.value = String(rows[i]?.[k] ?? ''))));
  }

  private cell(input: HTMLInputElement): number {
    const value = numberFrom(input.value);
    if (Number.isFinite(value)) return value;
    const label = input.getAttribute('aria-label') ?? '';
    throw new FieldError(
      input.value.trim() === '' ? `${label}, is missing.` : `${label}: “${input.value}” is not a number.`,
      input,
    );
  }

  /** All rows that are not empty. FieldError: a cell is missing or not a number, or all rows are empty. */
  values(): [number, number][] {
    const filled = this.rows.filter(({ inputs }) => inputs.some((input) => input.value.trim() !== ''));
    if (filled.length === 0)
      throw new FieldError('There are no readings yet: type them in, or paste two columns.', this.rows[0].inputs[0]);
    return filled.map(({ inputs: [reading, angle] }) => [this.cell(reading), this.cell(angle)]);
  }
}
