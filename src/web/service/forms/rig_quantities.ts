// SPDX-License-Identifier: Apache-2.0
/** Fields for the quantities of a rig: a question, a number, its unit, and its standard deviation. */

import { el } from '../../shared/dom';
import type { Loose } from '../../shared/result_types';
import { labelOf, rigFlags } from '../flag_words';
import { FieldError } from '../server/problem';
import type { Flags } from '../types';
import { numberField, numberIn } from './forms';
import { numberFrom } from './numbers';

export interface Quantity {
  /** The key in a rig file. */
  name: string;
  /** The name of its flag. */
  flag: string;
  question: string;
  /** As the flag takes them; the first one is preselected. */
  units: string[];
  hint?: string;
  /** What is used if the field is empty. */
  otherwise?: string;
  /** The rig may be without it. */
  optional?: boolean;
}

const kMass = ['g', 'kg'];
const kLength = ['cm', 'm', 'mm'];
const kGravity: Quantity = {
  name: 'gravity',
  flag: 'g',
  question: 'How large is g where you are?',
  units: ['m/s^2'],
  otherwise: '9.806 ± 0.015',
  optional: true,
};

export const kMasses: Quantity[] = [
  { name: 'bob_mass', flag: 'bob_mass', question: 'How heavy is the bob?', units: kMass },
  { name: 'rod_mass', flag: 'rod_mass', question: 'How heavy is the rod?', units: kMass, hint: '0 for a string.' },
  {
    name: 'rod_length',
    flag: 'rod_length',
    question: 'How long is the rod?',
    units: kLength,
    hint: 'From the pivot to the bob’s centre.',
  },
  { ...kGravity, hint: 'Empty: as at sea level.' },
];
export const kTorque: Quantity[] = [
  {
    name: 'gravity_torque',
    flag: 'gravity_torque',
    question: 'How large is the gravity torque G?',
    units: ['N m', 'N cm', 'mN m'],
  },
];
export const kSpring: Quantity[] = [
  {
    name: 'stiffness',
    flag: 'stiffness',
    question: 'How stiff is the spring?',
    units: ['N m/rad', 'N cm/rad', 'mN m/rad', 'N/m'],
  },
];
export const kString: Quantity[] = [
  {
    name: 'length',
    flag: 'length',
    question: 'How long is the string?',
    units: kLength,
    hint: 'From the support to the bob’s centre.',
    optional: true,
  },
  { ...kGravity, otherwise: undefined },
];
export const kInertia: Quantity[] = [
  {
    name: 'inertia',
    flag: 'inertia',
    question: 'How large is the moment of inertia?',
    units: ['kg m^2', 'kg cm^2', 'g m^2'],
  },
  { name: 'mass', flag: 'mass', question: 'How heavy is the pendulum?', units: kMass, optional: true },
  { ...kGravity, otherwise: undefined },
];

interface Inputs {
  quantity: Quantity;
  value: HTMLInputElement;
  unit: HTMLSelectElement;
  error: HTMLInputElement;
}

/** [number, unit, standard deviation] of each quantity. */
export type FieldsState = Record<string, [string, string, string]>;

const written = (unit: string): string => unit.replace('^2', '²');

const deviationOf = (quantity: Quantity): string => `Standard deviation of: ${labelOf(quantity.flag)}`;

/** "380+-1g" as [number, standard deviation, unit]; null: another text. */
function partsOf(words: string): [string, string, string] | null {
  const found = /^\s*([-+.\deE]*?\d\.?)\s*(?:(?:\+-|\+\/-|±)\s*([.\deE+-]*?\d\.?)\s*)?([a-zA-Z][^\d]*\d?)?\s*$/.exec(words);
  return found && [found[1], found[2] ?? '', (found[3] ?? '').trim()];
}

function unitMenu(quantity: Quantity): HTMLSelectElement {
  const menu = el('select', { 'aria-label': `Unit of: ${labelOf(quantity.flag)}` });
  for (const unit of quantity.units) menu.append(el('option', { value: unit }, written(unit)));
  return menu;
}

export class QuantityFields {
  readonly element = el('div', { class: 'quantities' });
  private readonly inputs: Inputs[];

  constructor(quantities: Quantity[]) {
    this.inputs = quantities.map((quantity) => this.row(quantity));
  }

  private row(quantity: Quantity): Inputs {
    const value = numberField(quantity.question, quantity.hint);
    const error = numberField('±', '', { 'aria-label': deviationOf(quantity) });
    const unit = unitMenu(quantity);
    value.input.placeholder = quantity.otherwise ?? '';
    error.input.placeholder = 'unknown';
    for (const [field, name] of [[value, quantity.name], [error, `std_dev of ${quantity.name}`]] as const)
      field.input.dataset.rig = name;
    value.input.dataset.flag = quantity.flag;
    value.input.dataset.what = labelOf(quantity.flag);
    error.input.dataset.what = deviationOf(quantity);
    this.element.append(el('div', { class: 'quantity' }, value.element, unit, error.element));
    return { quantity, value: value.input, unit, error: error.input };
  }

  /** The value as its flag takes it: "380+-1g". FieldError: not a number. */
  private text({ quantity, value, unit, error }: Inputs): string {
    const deviation = numberIn(error, deviationOf(quantity));
    return `${numberIn(value, labelOf(quantity.flag))}${deviation ? `+-${deviation}` : ''}${unit.value}`;
  }

  /** The flags of all fields that have numbers. */
  get entered(): Flags {
    const isNumber = ({ value, error }: Inputs): boolean =>
      Number.isFinite(numberFrom(value.value)) && (error.value.trim() === '' || Number.isFinite(numberFrom(error.value)));
    return Object.fromEntries(this.inputs.filter(isNumber).map((one) => [one.quantity.flag, this.text(one)]));
  }

  /** The flags. FieldError: fields that must be filled are empty, all are empty, or one is not a number. */
  flags(): Flags {
    const isGiven = ({ value, error }: Inputs): boolean => value.value.trim() !== '' || error.value.trim() !== '';
    const given = this.inputs.filter(isGiven);
    const missing = this.inputs.filter(({ quantity, value }) => value.value.trim() === '' && !quantity.optional);
    const lonely = given.filter(({ value }) => value.value.trim() === '');
    const asked = missing.length > 0 ? missing : lonely.length > 0 ? lonely : given.length > 0 ? [] : this.inputs;
    if (asked.length > 0) {
      const questions = asked.map(({ quantity }) => quantity.question).join(missing.length > 0 ? ' ' : ' Or: ');
      throw new FieldError(`Please answer: ${questions}`, asked[0].value, asked.slice(1).map(({ value }) => value));
    }
    return Object.fromEntries(given.map((one) => [one.quantity.flag, this.text(one)]));
  }

  get state(): FieldsState {
    const entry = ({ quantity, value, unit, error }: Inputs): [string, [string, string, string]] => [
      quantity.name,
      [value.value, unit.value, error.value],
    ];
    return Object.fromEntries(this.inputs.map(entry));
  }

  restore(state: FieldsState): void {
    for (const inputs of this.inputs) {
      const [value, unit, error] = state[inputs.quantity.name] ?? ['', inputs.quantity.units[0], ''];
      this.set(inputs, value, unit, error);
    }
  }

  private set({ quantity, value, unit, error }: Inputs, number: string, of: string, deviation: string): void {
    value.value = number;
    unit.value = quantity.units.includes(of) ? of : quantity.units[0];
    error.value = deviation;
  }

  /** Fills in the fields if the rig has these quantities and no other. Returns whether it has. */
  fill(rig: Loose): boolean {
    const isKnown = (name: string): boolean => this.inputs.some(({ quantity }) => quantity.name === name);
    const isComplete = this.inputs.every(({ quantity }) => quantity.optional || quantity.name in rig);
    if (!isComplete || !Object.keys(rig).every(isKnown)) return false;
    for (const inputs of this.inputs) {
      const given = (rig[inputs.quantity.name] ?? '') as number | '' | { value: number; std_dev?: number };
      const [value, deviation] = typeof given === 'object' ? [given.value, given.std_dev ?? ''] : [given, ''];
      this.set(inputs, String(value), siUnitOf(inputs.quantity), String(deviation));
    }
    return true;
  }

  /** Fills in the fields if the rig's flags are for these quantities and no other. Returns whether they are. */
  fillFlags(flags: Flags): boolean {
    const own = this.inputs.map(({ quantity }) => quantity.flag);
    const given = rigFlags().filter((flag) => flags[flag] !== undefined);
    const isComplete = this.inputs.every(({ quantity }) => quantity.optional || given.includes(quantity.flag));
    if (given.length === 0 || !isComplete || !given.every((flag) => own.includes(flag))) return false;
    const parts = this.inputs.map((inputs) => ({ inputs, part: partsOf(flags[inputs.quantity.flag] ?? '') }));
    const isReadable = parts.every(({ inputs, part }) => {
      if (flags[inputs.quantity.flag] === undefined) return true;
      return part !== null && (part[2] === '' || inputs.quantity.units.includes(part[2]));
    });
    if (!isReadable) return false;
    for (const { inputs, part } of parts) {
      const [value, deviation, unit] = part ?? ['', '', ''];
      this.set(inputs, value, unit || siUnitOf(inputs.quantity), deviation);
    }
    return true;
  }
}

/** The unit that a rig file has for the quantity. */
function siUnitOf({ units }: Quantity): string {
  return ['kg', 'm', 'N m', 'N m/rad', 'kg m^2', 'm/s^2'].find((unit) => units.includes(unit)) ?? units[0];
}

/** The question that a flag of the rig answers; undefined for other flags. */
export const questionOf = (flag: string): string | undefined =>
  [...kMasses, ...kTorque, ...kSpring, ...kString, ...kInertia].find((quantity) => quantity.flag === flag)?.question;
