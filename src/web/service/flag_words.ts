// SPDX-License-Identifier: Apache-2.0
/** Labels of the form fields for flags. Forms and the sentences of the service use the same table. */

import { kResidualsTitle } from '../report/sections/residual_section';

export type Options = [value: string, words: string][];

/** A flag of a fit that has a field, as the service describes it in the page. */
export interface FormFlag {
  name: string;
  label: string;
  help: string;
  /** Unit of its number; may be empty. */
  unit: string;
  type: 'string' | 'number' | 'integer' | 'file';
  default: string;
  /** All its values, if they are words; otherwise empty. */
  words: Options;
}

/** Names of the quantities of a rig, by their flags. */
const kRig: Record<string, string> = {
  bob_mass: 'Mass of the bob',
  rod_mass: 'Mass of the rod',
  rod_length: 'Length of the rod',
  g: 'Gravity',
  gravity_torque: 'Gravity torque G',
  mass: 'Mass of the pendulum',
  center_of_mass: 'Distance of the centre of mass',
  length: 'Length of the string',
  stiffness: 'Stiffness of the spring',
  inertia: 'Moment of inertia',
};

/** Labels of names that have no field of their own: flags of a calibration and of a rig, and a section of the report. */
const kOthers: Record<string, string> = {
  ...kRig,
  order: 'Order of the curve',
  bits: 'Bits of the converter',
  residuals: kResidualsTitle,
};

let flags: FormFlag[] = [];

/** Sets the flags that have a field. */
export function setFlags(described: FormFlag[]): void {
  flags = described;
}

/** The flags that have a field, in the order of the form. */
export const formFlags = (): readonly FormFlag[] => flags;

const flagOf = (name: string): FormFlag | undefined =>
  flags.find((flag) => flag.name === (name === 'models' ? 'model' : name));

const knownLabel = (name: string): string | undefined =>
  flagOf(name)?.label ?? (Object.hasOwn(kOthers, name) ? kOthers[name] : undefined);

/** Label of the field for a flag. */
export const labelOf = (name: string): string => knownLabel(name) ?? name;

/** The flags of a rig. */
export const rigFlags = (): string[] => Object.keys(kRig);

/** The label with the unit: "From [s]". */
export function labelWithUnit(name: string): string {
  const unit = flagOf(name)?.unit ?? '';
  return unit === '' ? labelOf(name) : `${labelOf(name)} [${unit}]`;
}

/** What a flag means, in the words of the page. */
export const helpOf = (name: string): string => inFields(flagOf(name)?.help ?? '');

/** The options of a flag. */
export const optionsOf = (name: string): Options => flagOf(name)?.words ?? [];

/** Sets the names that the page uses for the friction laws. */
export function nameModels(models: readonly { name: string; label: string }[]): void {
  const model = flagOf('model');
  if (model) model.words = [['all', 'all'], ...models.map(({ name, label }): Options[number] => [name, label])];
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
    const label = knownLabel(flag);
    if (label === undefined) return all;
    const chosen = next === '' ? null : chosenWords(next, optionsOf(flag));
    return chosen === null ? `“${label}”${space}${next}` : `“${label}: ${chosen}”`;
  });
  return told === sentence
    ? sentence
    : told.replace(/\bleave (the flag|one of them|“[^”]*”) out\b/g, (_all, what: string) =>
        what === 'the flag' ? 'leave that field empty' : `leave ${what} empty`,
      );
}

/** The flags that a sentence names, in order. */
export const flagsIn = (sentence: string): string[] => [...sentence.matchAll(/--([a-z][a-z_]*)/g)].map(([, flag]) => flag);
