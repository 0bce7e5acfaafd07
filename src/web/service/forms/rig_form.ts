// SPDX-License-Identifier: Apache-2.0
/** The rig file as a form: what is known about the pendulum without a recording. */

import { choice, el, text } from '../../shared/dom';
import type { Loose } from '../../shared/result_types';
import { labelOf } from '../flag_words';
import { FieldError } from '../server/problem';
import { fileField, neededNumber, numberField, numberIn } from './forms';

type Kind = 'none' | 'masses' | 'torque' | 'file';

interface Quantity {
  name: string;
  label: string;
  unit: string;
  value?: string;
}

const kMasses: Quantity[] = [
  { name: 'bob_mass', label: 'Mass of the bob', unit: 'kg' },
  { name: 'rod_mass', label: 'Mass of the rod', unit: 'kg' },
  { name: 'rod_length', label: 'Length of the rod', unit: 'm' },
  { name: 'gravity', label: 'Gravity', unit: 'm/s²', value: '9.81' },
];
const kTorque: Quantity[] = [{ name: 'gravity_torque', label: 'Gravity torque G', unit: 'N m' }];

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

  /** The rig. FieldError: a field is empty or not a number. */
  rig(): Loose {
    return Object.fromEntries(
      this.inputs.map(({ quantity, value, error }) => {
        const number = neededNumber(value, quantity.label);
        const deviation = numberIn(error, deviationOf(quantity));
        return [quantity.name, deviation ? { value: number, std_dev: deviation } : number];
      }),
    );
  }

  /** Fills in the fields if the rig has exactly these quantities. Returns whether it has. */
  fill(rig: Loose): boolean {
    const names = Object.keys(rig);
    if (names.length !== this.inputs.length || !this.inputs.every(({ quantity }) => quantity.name in rig)) return false;
    for (const { quantity, value, error } of this.inputs) {
      const given = rig[quantity.name] as number | { value: number; std_dev?: number };
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
    const file = this.file.input.files?.[0];
    if (file) return file.text();
    if (this.given) return JSON.stringify(this.given);
    throw new FieldError('Choose the rig file, or another description of the pendulum.', this.file.input);
  }
}
