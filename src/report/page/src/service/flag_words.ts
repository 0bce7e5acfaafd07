// SPDX-License-Identifier: Apache-2.0
/** Flags as the fields that the page has for them: one table of labels for the forms and for the service's sentences. */

import { kResidualsTitle } from '../residual_section';

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
  residuals: { label: kResidualsTitle }, // no flag of a request, but a section of the report
} satisfies Record<string, FlagWords>;

export type FieldFlag = keyof typeof kFlags;

const wordsOf = (flag: string): FlagWords | null => (Object.hasOwn(kFlags, flag) ? kFlags[flag as FieldFlag] : null);

/** The label of the field of a flag. */
export const labelOf = (flag: FieldFlag): string => kFlags[flag].label;

/** What can be chosen for a flag; the first is the default. */
export const optionsOf = (flag: FieldFlag): Options => wordsOf(flag)?.options ?? [];

/** Tells what the kinds of friction are called on the page. */
export function nameModels(models: readonly { name: string; label: string }[]): void {
  kOfModel.options = [['all', 'all'], ...models.map(({ name, label }): Options[number] => [name, label])];
}

/** "viscous,drag" as the words of both; null where one is no option. */
function chosenWords(list: string, options: Options): string | null {
  const words = list.split(',').map((value) => options.find((option) => option[0] === value)?.[1]);
  return words.every((word) => word !== undefined) ? words.join(', ') : null;
}

const kFlag = /--([a-z][a-z_]*)(?:( )([a-z_,]*[a-z_]))?/g;

/** A sentence of the command line in the words of the page: "--noise quantized" by what its field and option are called. */
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

/** Flags that a sentence names, in its order. */
export const flagsIn = (sentence: string): string[] => [...sentence.matchAll(/--([a-z][a-z_]*)/g)].map(([, flag]) => flag);
