// SPDX-License-Identifier: Apache-2.0
/** Everything else that a fit can be told, folded away: each has a sensible default. */

import { button, el, text } from '../dom';
import type { Loose } from '../types';
import { fileField, numberField, numberIn, selectField, textField, type Field } from './forms';
import type { Flags } from './types';

const kStarts: [string, string][] = [
  ['', 'found in the recording'],
  ['release', 'held at rest, then released'],
  ['moving', 'already swinging'],
];
const kNoises: [string, string][] = [
  ['', 'found in the recording'],
  ['gaussian', 'even scatter'],
  ['quantized', 'rounding to the steps of the sensor'],
];
const kIntervals: [string, string][] = [
  ['', 'chosen by the fit'],
  ['covariance', 'from the covariance (fast)'],
  ['profile', 'from the likelihood'],
  ['bootstrap', 'from simulated repetitions (slow)'],
];
const kLosses: [string, string][] = [
  ['', 'there are none'],
  ['huber', 'count less (Huber)'],
  ['student', 'are expected (Student’s t)'],
];
const kUnits: [string, string][] = [
  ['', 'in the column’s name'],
  ['deg', 'degrees'],
  ['rad', 'radians'],
  ['deg_s', 'degrees per second'],
  ['rad_s', 'radians per second'],
  ['counts', 'counts of a converter'],
  ['volts', 'volts'],
];

type Input = HTMLInputElement | HTMLSelectElement;

/** A calibration that stands ready for the next fit. */
export interface ReadyCalibration {
  name: string;
  json: string;
}

export class OptionsForm {
  readonly element: HTMLDetailsElement;
  private readonly numbers: Record<string, Field<HTMLInputElement>> = {
    from: numberField('Use only from [s]', 'Else from where the free swing begins.'),
    to: numberField('Use only up to [s]', 'Else to where it ends.'),
    release: numberField('Which free swing', 'A number from 1; else the longest.'),
    sample_rate_hz: numberField('Samples per second', 'Only of a file without times.'),
  };
  private readonly words: Record<string, Field<Input>> = {
    start: selectField('How the recording begins', kStarts),
    time_column: textField('Column of times', 'Its name, or its number from 1; else found by name.'),
    value_column: textField('Column of the angle', 'Its name, or its number from 1; else found by unit.'),
    unit: selectField('Unit of the values', kUnits),
    noise: selectField('Noise of the sensor', kNoises),
    interval: selectField('95 % intervals', kIntervals),
    loss: selectField('Outliers', kLosses),
  };
  private readonly calibration = fileField(
    'Calibration file',
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
    for (const name of order) if (all[name]) fields.append(all[name].element);
    fields.append(el('div', {}, this.calibration.element, this.ready));
    this.calibration.input.addEventListener('change', () => this.use(null));
    this.element = el('details', { class: 'options' }, el('summary', {}, 'Further options'), fields);
  }

  /** Takes a calibration for the next fits; null: none. */
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

  /** Shows the options of a fit. */
  fill(flags: Flags, calibration: Loose | null): void {
    for (const [name, { input }] of Object.entries({ ...this.numbers, ...this.words })) input.value = flags[name] ?? '';
    this.use(calibration ? { name: 'the calibration of this fit', json: JSON.stringify(calibration) } : null);
    this.element.open = false;
  }

  /** Flags that differ from their defaults. FieldError: one is no number. */
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

  /** Names of all flags that it knows. */
  get names(): string[] {
    return [...Object.keys(this.numbers), ...Object.keys(this.words)];
  }

  /** JSON text of the calibration; null of none. */
  async calibrationText(): Promise<string | null> {
    const file = this.calibration.input.files?.[0];
    return file ? file.text() : (this.given?.json ?? null);
  }
}
