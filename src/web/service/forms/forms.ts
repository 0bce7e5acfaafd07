// SPDX-License-Identifier: Apache-2.0
/** Form fields with labels. */

import { el, type Child } from '../../shared/dom';
import { FieldError } from '../server/problem';
import { numberFrom } from './numbers';

let fields = 0;

export interface Field<T extends HTMLElement> {
  element: HTMLElement;
  input: T;
}

/** An input with its label above and a hint below. */
export function labelled<T extends HTMLElement>(label: Child, input: T, hint = ''): Field<T> {
  const id = `field-${++fields}`;
  input.id = id;
  if (hint !== '') input.setAttribute('aria-describedby', `${id}-hint`);
  const element = el(
    'div',
    { class: 'field' },
    el('label', { for: id }, label),
    input,
    hint !== '' && el('small', { id: `${id}-hint` }, hint),
  );
  return { element, input };
}

export const textField = (label: string, hint = '', attributes: Record<string, string> = {}): Field<HTMLInputElement> =>
  labelled(label, el('input', { type: 'text', autocomplete: 'off', spellcheck: 'false', ...attributes }), hint);

export const numberField = (
  label: string,
  hint = '',
  attributes: Record<string, string> = {},
): Field<HTMLInputElement> => textField(label, hint, { inputmode: 'decimal', ...attributes });

/** A drop-down list. The first option is the default. */
export function selectField(label: string, options: [string, string][], hint = ''): Field<HTMLSelectElement> {
  const input = el('select');
  for (const [value, words] of options) input.append(el('option', { value }, words));
  return labelled(label, input, hint);
}

export const fileField = (label: string, hint = '', accept = '.json,application/json'): Field<HTMLInputElement> =>
  labelled(label, el('input', { type: 'file', accept }), hint);

/** The number in a field, as text for the service; null if the field is empty. FieldError: not a number. */
export function numberIn(input: HTMLInputElement, what: string): number | null {
  if (input.value.trim() === '') return null;
  const value = numberFrom(input.value);
  if (Number.isFinite(value)) return value;
  throw new FieldError(`${what}: “${input.value}” is not a number.`, input);
}

/** The number in a required field. FieldError: empty, or not a number. */
export function neededNumber(input: HTMLInputElement, what: string): number {
  const value = numberIn(input, what);
  if (value === null) throw new FieldError(`${what} is missing.`, input);
  return value;
}

/** A checkbox with its label, and a hint below. */
export function checkbox(label: Child, about = ''): Field<HTMLInputElement> {
  const input = el('input', { type: 'checkbox' });
  const words = el('span', {}, el('span', {}, label), about !== '' && el('small', {}, about));
  return { element: el('label', { class: 'check' }, input, words), input };
}
