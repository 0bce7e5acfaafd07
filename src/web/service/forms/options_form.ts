// SPDX-License-Identifier: Apache-2.0
/** The other options of a fit, collapsed. Each has a default. */

import { button, el, text } from '../../shared/dom';
import type { Loose } from '../../shared/result_types';
import { labelOf, optionsOf, type FieldFlag } from '../flag_words';
import type { Flags } from '../types';
import { fileField, numberField, numberIn, selectField, textField, type Field } from './forms';

type Input = HTMLInputElement | HTMLSelectElement;

const chosenField = (flag: FieldFlag): Field<HTMLSelectElement> => selectField(labelOf(flag), optionsOf(flag));

/** A calibration for the next fit. */
export interface ReadyCalibration {
  name: string;
  json: string;
}

export class OptionsForm {
  readonly element: HTMLDetailsElement;
  private readonly numbers: Record<string, Field<HTMLInputElement>> = {
    from: numberField(`${labelOf('from')} [s]`, 'Else from where the free swing begins.'),
    to: numberField(`${labelOf('to')} [s]`, 'Else to where it ends.'),
    release: numberField(labelOf('release'), 'A number from 1; else the longest.'),
    sample_rate_hz: numberField(labelOf('sample_rate_hz'), 'Only of a file without times.'),
  };
  private readonly words: Record<string, Field<Input>> = {
    start: chosenField('start'),
    time_column: textField(labelOf('time_column'), 'Its name, or its number from 1; else found by name.'),
    value_column: textField(labelOf('value_column'), 'Its name, or its number from 1; else found by unit.'),
    unit: chosenField('unit'),
    noise: chosenField('noise'),
    interval: chosenField('interval'),
    loss: chosenField('loss'),
  };
  private readonly calibration = fileField(
    labelOf('calibration'),
    'Turns counts or volts into an angle; the Calibration page makes one.',
  );
  private readonly ready = el('div', { class: 'ready' });
  private given: ReadyCalibration | null = null;

  constructor(withWindow = true) {
    if (!withWindow) for (const name of ['from', 'to']) delete this.numbers[name];
    const fields = el('div', { class: 'fields' });
    const all: Record<string, Field<Input>> = { ...this.numbers, ...this.words };
    const order = [
      'from',
      'to',
      'start',
      'release',
      'value_column',
      'time_column',
      'unit',
      'sample_rate_hz',
      'noise',
      'interval',
      'loss',
    ];
    for (const name of order) {
      if (!all[name]) continue;
      all[name].input.dataset.flag = name;
      fields.append(all[name].element);
    }
    this.calibration.input.dataset.flag = 'calibration';
    fields.append(el('div', {}, this.calibration.element, this.ready));
    this.calibration.input.addEventListener('change', () => this.use(null));
    this.element = el('details', { class: 'options' }, el('summary', {}, 'Further options'), fields);
  }

  /** Sets the calibration for the next fits; null for none. */
  use(calibration: ReadyCalibration | null): void {
    this.given = calibration;
    this.ready.replaceChildren();
    if (!calibration) return;
    this.calibration.input.value = '';
    this.ready.append(
      text(`In use: ${calibration.name}.`, 'quiet'),
      button('Use none', () => this.use(null)),
    );
    this.element.open = true;
  }

  get usesCalibration(): boolean {
    return this.given !== null;
  }

  /** Fills the form with the options of a fit. */
  fill(flags: Flags, calibration: Loose | null): void {
    for (const [name, { input }] of Object.entries({ ...this.numbers, ...this.words })) input.value = flags[name] ?? '';
    this.use(calibration ? { name: 'the calibration of this fit', json: JSON.stringify(calibration) } : null);
    this.element.open = false;
  }

  /** Flags that differ from their defaults. FieldError: a value is not a number. */
  flags(): Flags {
    const flags: Flags = {};
    for (const [name, { input, element }] of Object.entries(this.numbers)) {
      const value = numberIn(input, element.querySelector('label')?.textContent ?? name);
      if (value !== null) flags[name] = String(value);
    }
    for (const [name, { input }] of Object.entries(this.words))
      if (input.value.trim() !== '') flags[name] = input.value.trim();
    return flags;
  }

  /** Names of all flags in this form. */
  get names(): string[] {
    return [...Object.keys(this.numbers), ...Object.keys(this.words)];
  }

  /** JSON text of the calibration; null for none. */
  async calibrationText(): Promise<string | null> {
    const file = this.calibration.input.files?.[0];
    return file ? file.text() : (this.given?.json ?? null);
  }
}
