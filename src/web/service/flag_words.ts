// SPDX-License-Identifier: Apache-2.0
/** Labels of the form fields for flags. Forms and the sentences of the service use the same table. */

import { kResidualsTitle } from '../report/sections/residual_section';

export type Options = [value: string, words: string][];

interface FlagWords {
  label: string;
  options?: Options;
}

const kStarts: Options = [
  ['', 'found in the recording'],
  ['release', 'held at rest, then released'],
  ['moving', 'already swinging'],
];
const kNoises: Options = [
  ['', 'found in the recording'],
  ['gaussian', 'even scatter'],
  ['quantized', 'rounding to the steps of the sensor'],
  ['edges', 'edges of an encoder’s counts, a row for each change'],
];
const kIntervals: Options = [
  ['', 'chosen by the fit'],
  ['covariance', 'from the covariance (fast)'],
  ['profile', 'from the likelihood'],
  ['bootstrap', 'from simulated repetitions (slow)'],
];
const kLosses: Options = [
  ['', 'there are none'],
  ['huber', 'count less (Huber)'],
  ['student', 'are expected (Student’s t)'],
];
const kUnits: Options = [
  ['', 'in the column’s name'],
  ['deg', 'degrees'],
  ['rad', 'radians'],
  ['deg_s', 'degrees per second'],
  ['rad_s', 'radians per second'],
  ['counts', 'counts of a converter'],
  ['volts', 'volts'],
  ['m_s2', 'metres per second squared'],
  ['px', 'pixels'],
  ['m', 'metres'],
  ['cm', 'centimetres'],
  ['mm', 'millimetres'],
];
const kOfModel: FlagWords = { label: 'Kind of friction', options: [['all', 'all']] };

const kFlags = {
  from: { label: 'From' },
  to: { label: 'To' },
  start: { label: 'How the recording begins', options: kStarts },
  release: { label: 'Which free swing' },
  time_column: { label: 'Column of times', options: [['none', 'none']] },
  value_column: { label: 'Column of the angle' },
  unit: { label: 'Unit of the values', options: kUnits },
  sample_rate_hz: { label: 'Samples per second' },
  noise: { label: 'Noise of the sensor', options: kNoises },
  interval: { label: '95 % intervals', options: kIntervals },
  loss: { label: 'Outliers', options: kLosses },
  calibration: { label: 'Calibration file' },
  model: kOfModel,
  models: kOfModel,
  rig: { label: 'What I know of the pendulum' },
  order: { label: 'Order of the curve' },
  bits: { label: 'Bits of the converter' },
  residuals: { label: kResidualsTitle }, // not a flag of a request but a section of the report
} satisfies Record<string, FlagWords>;

export type FieldFlag = keyof typeof kFlags;

const wordsOf = (flag: string): FlagWords | null => (Object.hasOwn(kFlags, flag) ? kFlags[flag as FieldFlag] : null);

/** Label of the field for a flag. */
export const labelOf = (flag: FieldFlag): string => kFlags[flag].label;

/** The options of a flag. The first is the default. */
export const optionsOf = (flag: FieldFlag): Options => wordsOf(flag)?.options ?? [];

/** Sets the names that the page uses for the friction laws. */
export function nameModels(models: readonly { name: string; label: string }[]): void {
  kOfModel.options = [['all', 'all'], ...models.map(({ name, label }): Options[number] => [name, label])];
}

/** Labels of the options in "viscous,drag"; null if one is not an option. */
function chosenWords(list: string, options: Options): string | null {
  const words = list.split(',').map((value) => options.find((option) => option[0] === value)?.[1]);
  return words.every((word) => word !== undefined) ? words.join(', ') : null;
}

const kFlag = /--([a-z][a-z_]*)(?:( )([a-z_,]*[a-z_]))?/g;

/**
 * A sentence with flags in the words of the page: "--noise quantized" becomes the labels of the field and of the
 * option.
 */
export function inFields(sentence: string): string {
  const told = sentence.replace(kFlag, (all: string, flag: string, space = '', next = '') => {
    const field = wordsOf(flag);
    if (!field) return all;
    const chosen = next === '' ? null : chosenWords(next, field.options ?? []);
    return chosen === null ? `“${field.label}”${space}${next}` : `“${field.label}: ${chosen}”`;
  });
  return told === sentence
    ? sentence
    : told.replace(/\bleave (the flag|one of them|“[^”]*”) out\b/g, (_all, what: string) =>
        what === 'the flag' ? 'leave that field empty' : `leave ${what} empty`,
      );
}

/** The flags that a sentence names, in order. */
export const flagsIn = (sentence: string): string[] => [...sentence.matchAll(/--([a-z][a-z_]*)/g)].map(([, flag]) => flag);
