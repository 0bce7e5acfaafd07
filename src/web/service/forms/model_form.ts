// SPDX-License-Identifier: Apache-2.0
/** The form for the friction law. */

import { choice, el, text } from '../../shared/dom';
import { labelOf, nameModels } from '../flag_words';
import { askJson } from '../server/api';
import { FieldError } from '../server/problem';
import type { ModelInfo } from '../types';
import { checkbox } from './forms';

export const kCompared = ['viscous', 'coulomb', 'drag'];

let known: ModelInfo[] | null = null;

/** The laws that the service knows. Requested only once. */
export async function knownModels(signal?: AbortSignal): Promise<ModelInfo[]> {
  known ??= (await askJson<{ models: ModelInfo[] }>('/v1/models', { signal })).models;
  nameModels(known);
  return known;
}

const isDefault = (names: readonly string[]): boolean =>
  names.length === kCompared.length && kCompared.every((name) => names.includes(name));

export class ModelForm {
  readonly element = el('div', { class: 'models-form' });
  private own = false;
  private chosen = new Set(kCompared);
  private models: ModelInfo[] = [];
  private readonly boxes = el('div', { class: 'checks', role: 'group', 'aria-label': 'Kinds of friction' });

  constructor() {
    this.draw();
  }

  /** The available laws. */
  set(models: ModelInfo[]): void {
    this.models = models;
    this.draw();
  }

  /** Ticks the models of a fit. */
  fill(list: string): void {
    const all = this.models.filter((model) => model.gravity === this.models[0]?.gravity).map((model) => model.name);
    const names = list === 'all' ? all : list.split(',').map((name) => name.trim());
    this.chosen = new Set(names);
    this.own = !isDefault(names);
    this.draw();
  }

  /** Whether the user chooses, and which laws. */
  get state(): { own: boolean; chosen: string[] } {
    return { own: this.own, chosen: [...this.chosen] };
  }

  restore({ own, chosen }: ModelForm['state']): void {
    this.own = own;
    this.chosen = new Set(chosen);
    this.draw();
  }

  private draw(): void {
    const options = [
      { value: 'auto', label: 'find out for me' },
      { value: 'own', label: 'I choose' },
    ];
    const chooser = choice(labelOf('model'), options, this.own ? 'own' : 'auto', (value) => {
      this.own = value === 'own';
      this.show();
    });
    this.boxes.replaceChildren(...this.models.map((model) => this.box(model)));
    this.element.replaceChildren(chooser, el('div', { class: 'more' }));
    this.show();
  }

  private box({ name, label, about }: ModelInfo): HTMLElement {
    const { element, input } = checkbox(label, about);
    input.value = name;
    input.checked = this.chosen.has(name);
    input.addEventListener('change', () => {
      if (input.checked) this.chosen.add(name);
      else this.chosen.delete(name);
    });
    return element;
  }

  private show(): void {
    const auto =
      'Viscous friction, dry friction and air drag are fitted and compared; the result says which one holds, and why.';
    const own = text('Tick one, or several to compare them.', 'quiet');
    this.element.querySelector('.more')?.replaceChildren(...(this.own ? [own, this.boxes] : [text(auto, 'quiet')]));
  }

  /** The ticked laws for a preview, which needs none. */
  get entered(): string {
    return this.own ? [...this.chosen].join(',') : kCompared.join(',');
  }

  /** The ticked laws, "viscous,coulomb,drag". FieldError: none is ticked. */
  value(): string {
    if (!this.own) return kCompared.join(',');
    const names = this.models.filter((model) => this.chosen.has(model.name)).map((model) => model.name);
    const first = this.boxes.querySelector('input');
    if (names.length === 0 && first) throw new FieldError('Tick at least one kind of friction.', first);
    return names.join(',');
  }
}
