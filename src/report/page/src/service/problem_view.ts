// SPDX-License-Identifier: Apache-2.0
/** Shows what went wrong where it is read out, with the focus on it. */

import { button, el, text } from '../dom';
import { adviceFor, Cancelled, FieldError, problemOf } from './problem';

/** A problem in words; `again` is what its button does. */
export function problemBox(error: unknown, again?: () => void): HTMLElement {
  const problem = problemOf(error);
  const advice = adviceFor(problem);
  const words = el(
    'div',
    {},
    el('p', { class: 'title' }, problem.title),
    el('p', { class: 'detail' }, problem.detail),
    advice !== '' && text(advice, 'advice'),
    again && button('Try again', again),
  );
  const sign = el('span', { class: 'sign', 'aria-hidden': 'true' }, '✕');
  return el('div', { class: 'banner bad problem', tabindex: '-1' }, sign, words);
}

/** An element for problems, which are read out as they come. */
export const alertPlace = (): HTMLElement => el('div', { role: 'alert', class: 'alert-place' });

/** Puts the problem into its place; nothing for what the user ended, or for a view that was left. */
export function showProblem(place: HTMLElement, error: unknown, again?: () => void): void {
  place.replaceChildren();
  if (error instanceof DOMException && error.name === 'AbortError') return;
  if (error instanceof Cancelled) {
    place.append(text(error.message, 'absent'));
    return;
  }
  const box = problemBox(error, again);
  place.append(box);
  if (error instanceof FieldError) {
    error.field.setAttribute('aria-invalid', 'true');
    error.field.closest('details')?.setAttribute('open', '');
    error.field.focus();
  } else {
    box.focus();
  }
  box.scrollIntoView({ block: 'nearest' });
}

/** Runs what a control started; its problems go to `place`, and meanwhile the control is off. */
export async function attempt(
  control: HTMLButtonElement | null,
  place: HTMLElement,
  action: () => Promise<void>,
): Promise<void> {
  const again = (): void => void attempt(control, place, action);
  place.replaceChildren();
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
