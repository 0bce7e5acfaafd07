// SPDX-License-Identifier: Apache-2.0
/** Menus for the columns of a recording and their units, with the choice of the reader preselected. */

import { el } from '../../shared/dom';
import { helpOf, labelOf, optionsOf, type Options } from '../flag_words';
import type { Flags, Preview } from '../types';
import { labelled, numberField, type Field } from './forms';

/** The flags that these menus set. */
export const kColumnFlags = ['time_column', 'value_column', 'unit', 'sample_rate_hz'];

const kNone = 'none';
const kTimeUnits: Options = [
  ['s', 'seconds'],
  ['ms', 'milliseconds'],
  ['us', 'microseconds'],
  ['ns', 'nanoseconds'],
  ['min', 'minutes'],
  ['days', 'days'],
];

function fill(menu: HTMLSelectElement, options: Options, chosen: string): void {
  const isKnown = options.some(([value]) => value === chosen);
  const all: Options = isKnown ? options : [['', 'please choose'], ...options];
  menu.replaceChildren(...all.map(([value, words]) => el('option', { value }, words)));
  menu.value = isKnown ? chosen : '';
}

const isAsked = (preview: Preview, option: string): boolean =>
  preview.missing.some(({ options }) => options.includes(option));

export class ColumnForm {
  readonly element = el('div', { class: 'fields columns' });
  private readonly time: Field<HTMLSelectElement>;
  private readonly timeUnit: Field<HTMLSelectElement>;
  private readonly rate: Field<HTMLInputElement>;
  private readonly reading: Field<HTMLSelectElement>;
  private readonly unit: Field<HTMLSelectElement>;

  /**
   * `change` is called with the flags that the user has changed; an empty value removes a flag. `isTyping`: the user may
   * still change them.
   */
  constructor(
    preview: Preview,
    given: Flags,
    private readonly change: (flags: Flags, isTyping?: boolean) => void,
  ) {
    this.time = labelled(labelOf('time_column'), el('select', { 'data-flag': 'time_column' }));
    this.timeUnit = labelled('Unit of the times', el('select', { 'data-flag': 'time_unit' }));
    this.rate = numberField(labelOf('sample_rate_hz'), helpOf('sample_rate_hz'), { 'data-flag': 'sample_rate_hz' });
    this.reading = labelled(labelOf('value_column'), el('select', { 'data-flag': 'value_column' }));
    this.unit = labelled(labelOf('unit'), el('select', { 'data-flag': 'unit' }));
    this.fill(preview, given);
    const { time, timeUnit, rate, reading, unit } = this;
    this.element.append(time.element, timeUnit.element, rate.element, reading.element, unit.element);
    time.input.addEventListener('change', () => this.changeTime());
    timeUnit.input.addEventListener('change', () =>
      this.change({ time_column: `${time.input.value}:${timeUnit.input.value}`, sample_rate_hz: '' }),
    );
    rate.input.addEventListener('input', () => this.changeRate(true));
    rate.input.addEventListener('change', () => this.changeRate(false));
    reading.input.addEventListener('change', () => this.change({ value_column: reading.input.value, unit: '' }));
    unit.input.addEventListener('change', () => this.change({ unit: unit.input.value }));
  }

  private fill(preview: Preview, given: Flags): void {
    const { columns, time, value } = preview;
    const asksForTime = isAsked(preview, 'time_column') || (isAsked(preview, 'sample_rate_hz') && given.time_column !== kNone);
    const times: Options = columns.map(({ name }) => [name, name]);
    const noColumn = 'no column: a constant rate, or stamps of a serial monitor';
    fill(this.time.input, [...times, [kNone, noColumn]], time ? columns[time.column].name : asksForTime ? '' : kNone);
    fill(this.timeUnit.input, kTimeUnits, time?.unit ?? '');
    this.timeUnit.element.hidden = !time;
    this.rate.input.value = given.sample_rate_hz ?? '';
    this.rate.element.hidden = time !== null && !isAsked(preview, 'sample_rate_hz');
    const asked = preview.missing.find(({ options }) => options[0] === 'value_column')?.values ?? [];
    const readings: Options =
      columns.length > 0
        ? columns.map(({ name, value_column }) => [value_column, name])
        : asked.map((name) => [name, name]);
    fill(this.reading.input, readings, value ? columns[value.column].value_column : '');
    fill(this.unit.input, optionsOf('unit').slice(1), value?.unit ?? '');
  }

  private changeTime(): void {
    const name = this.time.input.value;
    if (name !== kNone) return this.change({ time_column: name, sample_rate_hz: '' });
    this.timeUnit.element.hidden = true;
    this.rate.element.hidden = false;
    this.rate.input.focus();
  }

  private changeRate(isTyping: boolean): void {
    const rate = this.rate.input.value.trim();
    this.change({ time_column: rate === '' ? '' : kNone, sample_rate_hz: rate.replace(',', '.') }, isTyping);
  }
}
