// SPDX-License-Identifier: Apache-2.0
/** The rig file as a form: what is known about the pendulum without a recording. */

import { choice, el, text } from '../../shared/dom';
import type { Loose } from '../../shared/result_types';
import { labelOf } from '../flag_words';
import { FieldError } from '../server/problem';
import { fileField, neededNumber, numberField, numberIn } from './forms';

type Kind = 'none' | 'masses' | 'torque' | 'spring' | 'string' | 'inertia' | 'file';

interface Quantity {
  name: string;
  label: string;
  unit: string;
  value?: string;
  /** The rig may be without it. */
  optional?: boolean;
}

const kMasses: Quantity[] = [
  { name: 'bob_mass', label: 'Mass of the bob', unit: 'kg' },
  { name: 'rod_mass', label: 'Mass of the rod', unit: 'kg' },
  { name: 'rod_length', label: 'Length of the rod', unit: 'm' },
  { name: 'gravity', label: 'Gravity', unit: 'm/s²', value: '9.81' },
];
const kTorque: Quantity[] = [{ name: 'gravity_torque', label: 'Gravity torque G', unit: 'N m' }];

const kSpring: Quantity[] = [{ name: 'stiffness', label: 'Stiffness of the spring', unit: 'N m/rad' }];
const kString: Quantity[] = [
  { name: 'length', label: 'Length of the string', unit: 'm', optional: true },
  { name: 'gravity', label: 'Gravity', unit: 'm/s²', optional: true },
];
const kInertia: Quantity[] = [
  { name: 'inertia', label: 'Moment of inertia', unit: 'kg m²' },
  { name: 'mass', label: 'Mass', unit: 'kg', optional: true },
  { name: 'gravity', label: 'Gravity', unit: 'm/s²', optional: true },
];

const deviationOf = ({ label }: Quantity): string => `Standard deviation of: ${label}`;

/** Fields for quantities and their standard deviations. */
class QuantityFields {
  readonly element = el('div', { class: 'quantities' });
  private readonly inputs: { quantity: Quantity; value: HTMLInputElement; error: HTMLInputElement }[] = [];

  constructor(quantities: Quantity[]) {
    for (const quantity of quantities) {
      const value = numberField(`${quantity.label} [${quantity.unit}]`);
      const error = numberField('±', '', {
        'aria-label': `${deviationOf(quantity)} [${quantity.unit}]`,
      });
      error.input.placeholder = 'unknown';
      value.input.value = quantity.value ?? '';
      value.input.dataset.rig = quantity.name;
      error.input.dataset.rig = `std_dev of ${quantity.name}`;
      value.input.dataset.what = quantity.label;
      error.input.dataset.what = deviationOf(quantity);
      this.inputs.push({ quantity, value: value.input, error: error.input });
      this.element.append(el('div', { class: 'quantity' }, value.element, error.element));
    }
  }

  /** The rig. FieldError: a field that must be filled is empty, all are empty, or one is not a number. */
  rig(): Loose {
    const isGiven = ({ quantity, value, error }: (typeof this.inputs)[number]): boolean =>
      !quantity.optional || value.value.trim() !== '' || error.value.trim() !== '';
    const given = this.inputs.filter(isGiven);
    if (given.length === 0) {
      const labels = this.inputs.map(({ quantity }) => quantity.label.toLowerCase()).join(' or ');
      throw new FieldError(`Give the ${labels}.`, this.inputs[0].value);
    }
    return Object.fromEntries(
      given.map(({ quantity, value, error }) => {
        const number = neededNumber(value, quantity.label);
        const deviation = numberIn(error, deviationOf(quantity));
        return [quantity.name, deviation ? { value: number, std_dev: deviation } : number];
      }),
    );
  }

  /** Fills in the fields if the rig has these quantities and no other. Returns whether it has. */
  fill(rig: Loose): boolean {
    const isKnown = (name: string): boolean => this.inputs.some(({ quantity }) => quantity.name === name);
    const isComplete = this.inputs.every(({ quantity }) => quantity.optional || quantity.name in rig);
    if (!isComplete || !Object.keys(rig).every(isKnown)) return false;
    for (const { quantity, value, error } of this.inputs) {
      const given = (rig[quantity.name] ?? '') as number | '' | { value: number; std_dev?: number };
      if (given === '') {
        value.value = error.value = '';
        continue;
      }
      value.value = String(typeof given === 'number' ? given : given.value);
      error.value = typeof given === 'number' ? '' : String(given.std_dev ?? '');
    }
    return true;
  }
}

export class RigForm {
  readonly element = el('div', { class: 'rig' });
  private kind: Kind = 'none';
  private readonly masses = new QuantityFields(kMasses);
  private readonly torque = new QuantityFields(kTorque);
  private readonly spring = new QuantityFields(kSpring);
  private readonly string = new QuantityFields(kString);
  private readonly inertia = new QuantityFields(kInertia);
  private readonly file = fileField('Rig file (JSON, SI units)');
  private given: Loose | null = null;

  constructor() {
    this.file.input.dataset.rig = 'file';
    this.draw();
  }

  private draw(): void {
    const options = [
      { value: 'none', label: 'nothing' },
      { value: 'masses', label: 'masses and length' },
      { value: 'torque', label: 'its gravity torque' },
      { value: 'string', label: 'the length of a string, or gravity' },
      { value: 'inertia', label: 'its moment of inertia' },
      { value: 'spring', label: 'the stiffness of a spring or wire' },
      { value: 'file', label: this.given ? 'the rig as given' : 'a rig file' },
    ];
    const chooser = choice(labelOf('rig'), options, this.kind, (value) => {
      this.kind = value as Kind;
      this.show();
    });
    this.element.replaceChildren(chooser, el('div', { class: 'more' }));
    this.show();
  }

  private show(): void {
    const parts: Record<Kind, Node[]> = {
      none: [
        text('Inertia and friction are then told in units of the gravity torque G, not in kg m² and N m.', 'quiet'),
      ],
      masses: [
        this.masses.element,
        text('A rod with a bob at its end. The second column is the standard deviation, if it is known.', 'quiet'),
      ],
      torque: [this.torque.element, text('The torque that holds the pendulum level.', 'quiet')],
      string: [
        this.string.element,
        text('A small bob on a string or two: gravity follows from the length, the length from gravity.', 'quiet'),
      ],
      inertia: [
        this.inertia.element,
        text('From geometry or CAD. The fit then gives the gravity torque, or the stiffness of a spring.', 'quiet'),
      ],
      spring: [
        this.spring.element,
        text('A Pohl wheel, a torsion wire, or a mass on a spring (then N/m and kg).', 'quiet'),
      ],
      file: this.given
        ? [text('As the fit had it. Choose another file to replace it.', 'quiet'), this.file.element]
        : [this.file.element],
    };
    this.element.querySelector('.more')?.replaceChildren(...parts[this.kind]);
  }

  /** Fills the form with a rig. */
  fill(rig: Loose | null): void {
    this.given = null;
    if (rig === null) this.kind = 'none';
    else if (this.masses.fill(rig)) this.kind = 'masses';
    else if (this.torque.fill(rig)) this.kind = 'torque';
    else if (this.spring.fill(rig)) this.kind = 'spring';
    else if (this.inertia.fill(rig)) this.kind = 'inertia';
    else if (this.string.fill(rig)) this.kind = 'string';
    else {
      this.kind = 'file';
      this.given = rig;
    }
    this.draw();
  }

  /** JSON text of the rig; null for none. FieldError: an entry is missing or wrong. */
  async value(): Promise<string | null> {
    if (this.kind === 'none') return null;
    if (this.kind === 'masses') return JSON.stringify(this.masses.rig());
    if (this.kind === 'torque') return JSON.stringify(this.torque.rig());
    if (this.kind === 'spring') return JSON.stringify(this.spring.rig());
    if (this.kind === 'string') return JSON.stringify(this.string.rig());
    if (this.kind === 'inertia') return JSON.stringify(this.inertia.rig());
    const file = this.file.input.files?.[0];
    if (file) return file.text();
    if (this.given) return JSON.stringify(this.given);
    throw new FieldError('Choose the rig file, or another description of the pendulum.', this.file.input);
  }
}
