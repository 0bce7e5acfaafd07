// SPDX-License-Identifier: Apache-2.0
/** Shows problems, with the focus on them, so that screen readers read them. */

import { button, el, text } from '../../shared/dom';
import { inFields } from '../flag_words';
import { asFieldError, mark, unmarkAll } from '../forms/problem_fields';
import { adviceFor, Cancelled, FieldError, problemOf, titleOf } from '../server/problem';

let boxes = 0;

/** A problem in words. `again` is the action of its button. */
export function problemBox(error: unknown, again?: () => void): HTMLElement {
  const problem = problemOf(error);
  const advice = adviceFor(problem);
  const words = el(
    'div',
    {},
    el('p', { class: 'title' }, titleOf(problem)),
    el('p', { class: 'detail', id: `problem-${++boxes}` }, inFields(problem.detail)),
    advice !== '' && text(advice, 'advice'),
    again && button('Try again', again),
  );
  const sign = el('span', { class: 'sign', 'aria-hidden': 'true' }, '✕');
  return el('div', { class: 'banner bad problem', tabindex: '-1' }, sign, words);
}

/** An element for problems. Screen readers read new ones. */
export const alertPlace = (): HTMLElement => el('div', { role: 'alert', class: 'alert-place' });

/** Opens all collapsed parts around a field. */
function uncover(field: HTMLElement): void {
  for (let box = field.closest('details'); box; box = box.parentElement?.closest('details') ?? null) box.open = true;
}

/**
 * Appends a problem and marks the fields that it names. Returns the element for the focus: the first of these fields,
 * or the problem if it names none.
 */
export function tellProblem(place: HTMLElement, error: unknown, again?: () => void): HTMLElement {
  const main = place.closest('main') ?? document;
  const told = asFieldError(error, (selector) => main.querySelector<HTMLElement>(selector));
  const box = problemBox(told, again);
  place.append(box);
  if (!(told instanceof FieldError)) return box;
  const fields = [told.field, ...told.others];
  fields.forEach(uncover);
  for (const field of fields) mark(field, box.querySelector('.detail')?.id ?? '');
  return told.field;
}

/** Removes all problems and their marks from fields. */
export function clearProblems(place: HTMLElement): void {
  for (const { id } of place.querySelectorAll('.detail')) unmarkAll(id);
  place.replaceChildren();
}

/** Shows the problem in `place`, except after the user has cancelled the action or left the view. */
export function showProblem(place: HTMLElement, error: unknown, again?: () => void): void {
  clearProblems(place);
  if (error instanceof DOMException && error.name === 'AbortError') return;
  if (error instanceof Cancelled) {
    place.append(text(error.message, 'absent'));
    return;
  }
  tellProblem(place, error, again).focus();
  place.lastElementChild?.scrollIntoView({ block: 'nearest' });
}

/** Runs the action of a control, which is disabled meanwhile. Problems are shown in `place`. */
export async function attempt(
  control: HTMLButtonElement | null,
  place: HTMLElement,
  action: () => Promise<void>,
): Promise<void> {
  const again = (): void => void attempt(control, place, action);
  clearProblems(place);
  if (control) control.disabled = true;
  try {
    await action();
  } catch (error) {
    if (control) control.disabled = false;
    showProblem(place, error, again);
  } finally {
    if (control) control.disabled = false;
  }
}
