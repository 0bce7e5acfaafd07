// SPDX-License-Identifier: Apache-2.0
/**
 * A form for pasted numbers of a recording, kept until the tab is closed. It asks for the unit of columns without
 * names.
 */

import { button, details, el } from '../../shared/dom';
import { keep, kept } from '../../shared/kept';
import { labelOf, optionsOf } from '../flag_words';
import { FieldError } from '../server/problem';
import type { Flags } from '../types';
import { labelled, selectField, textField } from './forms';
import { isHeadless } from './numbers';
import type { Recording } from './submit';

const kNumbers = 'pendulum_pasted_numbers';
const kName = 'pendulum_pasted_name';
const kUnnamed = 'pasted numbers';

/** Adds the flags for two columns without names: times in seconds, then values in `unit`, if it is not empty. */
export function headlessFlags(unit: string, given: Flags): Flags {
  const times: Flags = given.sample_rate_hz === undefined ? { time_column: '1:s' } : {}; // integers could be s or ms
  return { ...times, value_column: '2', ...given, ...(unit === '' ? {} : { unit }) };
}

export class PasteForm {
  readonly element: HTMLDetailsElement;
  private readonly area = el('textarea', { rows: '8', spellcheck: 'false', autocomplete: 'off' });
  private readonly name = textField('Name of the recording');
  private readonly unit = selectField(
    labelOf('unit'),
    [['', 'please choose'], ...optionsOf('unit').slice(1)],
    'The first line names no columns: the first one is then time in seconds, the second one this.',
  );

  constructor(fit: (form: PasteForm) => void) {
    this.area.placeholder = 'time_s,angle_deg\n0.00,24.2\n0.02,24.2\n0.04,23.9';
    this.area.value = kept('closed', kNumbers) ?? '';
    this.name.input.value = kept('closed', kName) ?? kUnnamed;
    this.area.addEventListener('input', () => {
      keep('closed', kNumbers, this.area.value);
      this.askUnit();
    });
    this.name.input.addEventListener('input', () => keep('closed', kName, this.name.input.value));
    this.askUnit();
    this.element = details('Or paste numbers', () => this.make(fit), this.area.value !== '');
    this.element.classList.add('options');
  }

  private askUnit(): void {
    const headless = isHeadless(this.area.value);
    this.unit.element.hidden = !headless;
    if (headless) this.unit.input.dataset.flag = 'unit';
    else delete this.unit.input.dataset.flag;
  }

  private make(fit: (form: PasteForm) => void): HTMLElement {
    const hint = 'Two columns, times and angles, as in a spreadsheet or a file.';
    const press = button('Fit these numbers', () => fit(this), { class: 'primary' });
    const numbers = labelled('Numbers', this.area, hint);
    return el('div', { class: 'paste' }, numbers.element, this.unit.element, this.name.element, press);
  }

  get recording(): Recording {
    const content = new Blob([this.area.value], { type: 'text/csv' });
    return { name: this.name.input.value || kUnnamed, content };
  }

  /** The given flags plus those for columns without names. FieldError: no numbers, or no unit. */
  flags(given: Flags): Flags {
    if (this.area.value.trim() === '') throw new FieldError('There are no numbers yet: paste them first.', this.area);
    if (!isHeadless(this.area.value)) return given;
    const unit = this.unit.input.value;
    if (unit === '' && given.unit === undefined)
      throw new FieldError(`${labelOf('unit')}: choose what the second column is in.`, this.unit.input);
    return headlessFlags(unit, given);
  }
}
