// SPDX-License-Identifier: Apache-2.0
/** The other options of a fit, collapsed. Each has a default. */

import { button, el, text } from '../../shared/dom';
import type { Loose } from '../../shared/result_types';
import { formFlags, helpOf, labelOf, labelWithUnit, type FormFlag } from '../flag_words';
import type { Flags } from '../types';
import { kColumnFlags } from './column_form';
import { fileField, numberField, numberIn, selectField, textField, type Field } from './forms';

const kWindow = ['from', 'to'];

type Input = HTMLInputElement | HTMLSelectElement;

const isNumber = ({ type }: FormFlag): boolean => type === 'number' || type === 'integer';

/** The field of a flag: a list of its words, or an input with what it means below. */
function fieldOf(flag: FormFlag): Field<Input> {
  const label = labelWithUnit(flag.name);
  if (flag.words.length > 0) return selectField(label, flag.words);
  return (isNumber(flag) ? numberField : textField)(label, helpOf(flag.name));
}

/** A calibration for the next fit. */
export interface ReadyCalibration {
  name: string;
  json: string;
}

/** All that a user has entered. */
export interface OptionsState {
  values: Flags;
  calibration: ReadyCalibration | null;
}

export class OptionsForm {
  readonly element: HTMLDetailsElement;
  private readonly list = el('div', { class: 'fields' });
  private readonly fields: { flag: FormFlag; field: Field<Input> }[] = [];
  private readonly calibration = fileField(
    labelOf('calibration'),
    `${helpOf('calibration')} The Calibration page makes one.`,
  );
  private readonly ready = el('div', { class: 'ready' });
  private given: ReadyCalibration | null = null;

  constructor(withWindow = true) {
    const fields = this.list;
    for (const flag of formFlags()) {
      if (flag.type === 'file' || flag.name === 'model' || (!withWindow && kWindow.includes(flag.name))) continue;
      const field = fieldOf(flag);
      field.input.dataset.flag = flag.name;
      fields.append(field.element);
      this.fields.push({ flag, field });
    }
    this.calibration.input.dataset.flag = 'calibration';
    fields.append(el('div', {}, this.calibration.element, this.ready));
    this.calibration.input.addEventListener('change', () => void this.takeFile());
    this.element = el('details', { class: 'options' }, el('summary', {}, 'Further options'), fields);
  }

  /** Reads the chosen file, because a browser does not keep it over a reload. */
  private async takeFile(): Promise<void> {
    const file = this.calibration.input.files?.[0];
    this.use(null, false);
    if (!file) return;
    const json = await file.text().catch(() => null); // calibrationText() reports it
    if (json !== null && this.calibration.input.files?.[0] === file) this.given = { name: file.name, json };
    this.element.dispatchEvent(new Event('change', { bubbles: true }));
  }

  /** Sets the calibration for the next fits; null for none. */
  use(calibration: ReadyCalibration | null, clears = true): void {
    this.given = calibration;
    this.ready.replaceChildren();
    if (clears) this.calibration.input.value = '';
    if (!calibration) return;
    this.ready.append(
      text(`In use: ${calibration.name}.`, 'quiet'),
      button('Use none', () => {
        this.use(null);
        this.element.dispatchEvent(new Event('change', { bubbles: true }));
      }),
    );
    this.element.open = true;
  }

  /** What the user has entered, for restore(). */
  get state(): OptionsState {
    const values = Object.fromEntries(this.fields.map(({ flag, field }) => [flag.name, field.input.value]));
    return { values, calibration: this.given };
  }

  restore({ values, calibration }: OptionsState): void {
    this.put(values);
    this.use(calibration);
    this.element.open = false;
  }

  /** Sets some fields. */
  put(values: Flags): void {
    for (const { flag, field } of this.fields) if (values[flag.name] !== undefined) field.input.value = values[flag.name];
  }

  /** Removes the fields for columns and units from the form, or puts them back. Their values still count. */
  hideColumns(hide: boolean): void {
    const own = this.fields.filter(({ flag }) => kColumnFlags.includes(flag.name));
    if (hide) for (const { field } of own) field.element.remove();
    else this.list.prepend(...own.map(({ field }) => field.element));
  }

  /** The given flags for columns and units. */
  get columnFlags(): Flags {
    return Object.fromEntries(
      this.fields
        .filter(({ flag, field }) => kColumnFlags.includes(flag.name) && field.input.value.trim() !== '')
        .map(({ flag, field }) => [flag.name, field.input.value.trim()]),
    );
  }

  get usesCalibration(): boolean {
    return this.given !== null;
  }

  /** Fills the form with the options of a fit. */
  fill(flags: Flags, calibration: Loose | null): void {
    for (const { flag, field } of this.fields) field.input.value = flags[flag.name] ?? (flag.words.length > 0 ? flag.default : '');
    this.use(calibration ? { name: 'the calibration of this fit', json: JSON.stringify(calibration) } : null);
    this.element.open = false;
  }

  /** Flags that differ from their defaults. FieldError: a value is not a number. */
  flags(): Flags {
    const flags: Flags = {};
    for (const { flag, field } of this.fields) {
      const number = isNumber(flag) ? numberIn(field.input as HTMLInputElement, labelWithUnit(flag.name)) : null;
      const value = number === null ? field.input.value.trim() : String(number);
      if (value !== '' && value !== flag.default) flags[flag.name] = value;
    }
    return flags;
  }

  /** Names of all flags in this form. */
  get names(): string[] {
    return this.fields.map(({ flag }) => flag.name);
  }

  /** JSON text of the calibration; null for none. */
  async calibrationText(): Promise<string | null> {
    const file = this.calibration.input.files?.[0];
    return file && !this.given ? file.text() : (this.given?.json ?? null);
  }
}
