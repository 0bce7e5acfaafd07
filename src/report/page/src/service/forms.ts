// SPDX-License-Identifier: Apache-2.0
/** Fields of forms with their labels. */

import { el, type Child } from '../dom';
import { numberFrom } from './numbers';
import { FieldError } from './problem';

let fields = 0;

export interface Field<T extends HTMLElement> {
  element: HTMLElement;
  input: T;
}

/** A label over its input, and what to know of it beneath. */
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

/** A list to choose from; the first is the default. */
export function selectField(label: string, options: [string, string][], hint = ''): Field<HTMLSelectElement> {
  const input = el('select');
  for (const [value, words] of options) input.append(el('option', { value }, words));
  return labelled(label, input, hint);
}

export const fileField = (label: string, hint = '', accept = '.json,application/json'): Field<HTMLInputElement> =>
  labelled(label, el('input', { type: 'file', accept }), hint);

/** The number of a field, as the service reads it; null of an empty one. FieldError: it is none. */
export function numberIn(input: HTMLInputElement, what: string): number | null {
  if (input.value.trim() === '') return null;
  const value = numberFrom(input.value);
  if (Number.isFinite(value)) return value;
  throw new FieldError(`${what}: “${input.value}” is not a number.`, input);
}

/** The same of a field that must be filled. */
export function neededNumber(input: HTMLInputElement, what: string): number {
  const value = numberIn(input, what);
  if (value === null) throw new FieldError(`${what} is missing.`, input);
  return value;
}

/** A box to tick with its words, and more about it beneath. */
export function checkbox(label: Child, about = ''): Field<HTMLInputElement> {
  const input = el('input', { type: 'checkbox' });
  const words = el('span', {}, el('span', {}, label), about !== '' && el('small', {}, about));
  return { element: el('label', { class: 'check' }, input, words), input };
}
