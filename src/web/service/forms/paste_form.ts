// SPDX-License-Identifier: Apache-2.0
/** A form for pasted numbers of a recording, kept until the tab is closed. */

import { button, details, el } from '../../shared/dom';
import { keep, kept } from '../../shared/kept';
import { FieldError } from '../server/problem';
import { labelled, textField } from './forms';
import type { Recording } from './submit';

const kNumbers = 'pendulum_pasted_numbers';
const kName = 'pendulum_pasted_name';
const kUnnamed = 'pasted numbers';

export class PasteForm {
  readonly element: HTMLDetailsElement;
  private readonly area = el('textarea', { rows: '8', spellcheck: 'false', autocomplete: 'off' });
  private readonly name = textField('Name of the recording');

  constructor(take: (form: PasteForm) => void) {
    this.area.placeholder = 'time_s,angle_deg\n0.00,24.2\n0.02,24.2\n0.04,23.9';
    this.area.value = kept('closed', kNumbers) ?? '';
    this.name.input.value = kept('closed', kName) ?? kUnnamed;
    this.area.addEventListener('input', () => keep('closed', kNumbers, this.area.value));
    this.name.input.addEventListener('input', () => keep('closed', kName, this.name.input.value));
    this.element = details('Or paste numbers', () => this.make(take), this.area.value !== '');
    this.element.classList.add('options');
  }

  private make(take: (form: PasteForm) => void): HTMLElement {
    const hint = 'Columns of times and readings, as in a spreadsheet, a file or a serial monitor.';
    const press = button('Fit these numbers', () => take(this), { class: 'primary' });
    const numbers = labelled('Numbers', this.area, hint);
    return el('div', { class: 'paste' }, numbers.element, this.name.element, press);
  }

  /** FieldError: there are no numbers. */
  get recording(): Recording {
    if (this.area.value.trim() === '') throw new FieldError('There are no numbers yet: paste them first.', this.area);
    const content = new Blob([this.area.value], { type: 'text/csv' });
    return { name: this.name.input.value || kUnnamed, content };
  }
}
