// SPDX-License-Identifier: Apache-2.0
/** What is known about the pendulum without a recording, in the units of the user, or as a rig file. */

import { choice, el, text } from '../../shared/dom';
import type { Loose } from '../../shared/result_types';
import { labelOf } from '../flag_words';
import { FieldError } from '../server/problem';
import type { Flags } from '../types';
import { fileField } from './forms';
import { kInertia, kMasses, kSpring, kString, kTorque, QuantityFields, type FieldsState } from './rig_quantities';

type Kind = 'none' | 'masses' | 'torque' | 'spring' | 'string' | 'inertia' | 'file';
type FieldKind = Exclude<Kind, 'none' | 'file'>;

/** The flags and the JSON text of a rig file that describe the pendulum. */
export interface RigChoice {
  flags: Flags;
  file: string | null;
}

/** All that a user has entered. */
export interface RigState {
  kind: Kind;
  fields: Record<string, FieldsState>;
  file: Loose | null;
}

const kKinds: FieldKind[] = ['masses', 'torque', 'spring', 'inertia', 'string'];

const kNotes: Record<FieldKind, string> = {
  masses: 'A rod with a bob at its end. The field after ± is the standard deviation, if you know it.',
  torque: 'The torque that holds the pendulum level.',
  string: 'A small bob on a string or two: gravity follows from the length, the length from gravity.',
  inertia: 'From geometry or CAD. The fit then gives the gravity torque, or the stiffness of a spring.',
  spring: 'A Pohl wheel, a torsion wire, or a mass on a spring (then N/m and kg).',
};

export class RigForm {
  readonly element = el('div', { class: 'rig' });
  private kind: Kind = 'none';
  private readonly fields: Record<FieldKind, QuantityFields> = {
    masses: new QuantityFields(kMasses),
    torque: new QuantityFields(kTorque),
    spring: new QuantityFields(kSpring),
    inertia: new QuantityFields(kInertia),
    string: new QuantityFields(kString),
  };
  private readonly file = fileField('Rig file (JSON, SI units)');
  private given: Loose | null = null;

  constructor() {
    this.file.input.dataset.rig = 'file';
    this.file.input.addEventListener('change', () => void this.takeFile());
    this.draw();
  }

  /**
   * Reads the chosen file, because a browser does not keep it over a reload. value() and the service report a file that
   * is not readable or not JSON.
   */
  private async takeFile(): Promise<void> {
    this.given = null;
    try {
      const words = await this.file.input.files?.[0]?.text();
      this.given = words === undefined ? null : (JSON.parse(words) as Loose);
    } catch {
      return;
    }
    this.element.dispatchEvent(new Event('change', { bubbles: true }));
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

  private parts(): Node[] {
    if (this.kind === 'none')
      return [text('Inertia and friction are then given in units of the gravity torque G, not in kg m² and N m.', 'quiet')];
    if (this.kind !== 'file') return [this.fields[this.kind].element, text(kNotes[this.kind], 'quiet')];
    const asGiven = text('The rig file is in use. Choose another file to replace it.', 'quiet');
    return this.given ? [asGiven, this.file.element] : [this.file.element];
  }

  private show(): void {
    this.element.querySelector('.more')?.replaceChildren(...this.parts());
  }

  /** Whether the user has chosen to say nothing about the pendulum. */
  get isEmpty(): boolean {
    return this.kind === 'none';
  }

  /** Fills the form with the rig file of a fit, or with the values in its flags. */
  fill(rig: Loose | null, flags: Flags = {}): void {
    this.given = null;
    const kind = kKinds.find((each) => (rig ? this.fields[each].fill(rig) : this.fields[each].fillFlags(flags)));
    this.kind = kind ?? (rig ? 'file' : 'none');
    if (!kind) this.given = rig;
    this.draw();
  }

  get state(): RigState {
    const fields = Object.fromEntries(kKinds.map((kind) => [kind, this.fields[kind].state]));
    return { kind: this.kind, fields, file: this.given };
  }

  restore({ kind, fields, file }: RigState): void {
    this.kind = kind === 'file' && file === null ? 'none' : kind; // a browser does not keep a chosen file
    this.given = file;
    for (const each of kKinds) if (fields[each]) this.fields[each].restore(fields[each]);
    this.draw();
  }

  /** The fields that are filled in, as far as they are numbers. */
  get entered(): Flags {
    return this.kind === 'none' || this.kind === 'file' ? {} : this.fields[this.kind].entered;
  }

  /** The description of the pendulum. FieldError: entries are missing or wrong. */
  async value(): Promise<RigChoice> {
    if (this.kind === 'none') return { flags: {}, file: null };
    if (this.kind !== 'file') return { flags: this.fields[this.kind].flags(), file: null };
    const file = this.file.input.files?.[0];
    if (file) return { flags: {}, file: await file.text() };
    if (this.given) return { flags: {}, file: JSON.stringify(this.given) };
    throw new FieldError('Choose the rig file, or another description of the pendulum.', this.file.input);
  }
}
