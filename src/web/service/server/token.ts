// SPDX-License-Identifier: Apache-2.0
/**
 * The token of the service. A link may carry it; otherwise the page asks for it if it is missing or wrong. It is kept
 * until the tab is closed.
 */

import { button, el, text } from '../../shared/dom';
import { Cancelled } from './problem';

const kKey = 'pendulum_token';
let asked: Promise<void> | null = null;

/** Empty if none was entered. */
export const token = (): string => sessionStorage.getItem(kKey) ?? '';

export const hasToken = (): boolean => token() !== '';

const kGiven = 'token';

/** Calls `changed` whenever a token is given. */
export const onToken = (changed: () => void): void => document.addEventListener(kGiven, changed);

function keep(words: string): void {
  sessionStorage.setItem(kKey, words);
  document.dispatchEvent(new Event(kGiven));
}

/** The address of the first view with the token in its fragment, which browsers do not send to servers. */
export const addressWithToken = (): string => `${location.origin}/#${String(new URLSearchParams({ token: token() }))}`;

/** Takes the token out of an address that carries it, and out of the history. Whether there was one. */
export function takeToken(): boolean {
  const given = new URLSearchParams(location.hash.slice(1)).get('token');
  if (given === null) return false;
  keep(given);
  history.replaceState(null, '', location.pathname + location.search);
  return true;
}

function openDialog(refused: boolean, given: (words: string) => void, cancelled: () => void): void {
  const input = el('input', { type: 'password', autocomplete: 'current-password', required: '', id: 'token' });
  const words = 'This service wants a token. Whoever runs it has it: it is what the service was started with.';
  const form = el(
    'form',
    {},
    el('h2', { id: 'token-title' }, 'Token'),
    refused && el('p', { role: 'alert', class: 'no' }, 'That token was not accepted.'),
    text(words),
    el('label', { for: 'token' }, 'Token'),
    input,
    text('It is kept in this tab only, until it is closed.', 'quiet'),
    el(
      'div',
      { class: 'actions' },
      el('button', { type: 'submit', class: 'primary' }, 'Go on'),
      button('Cancel', () => box.close()),
    ),
  );
  const box = el('dialog', { 'aria-labelledby': 'token-title' }, form);
  let done = false;
  form.addEventListener('submit', (event) => {
    event.preventDefault();
    done = true;
    box.close();
    given(input.value.trim());
  });
  box.addEventListener('close', () => {
    box.remove();
    if (!done) cancelled();
  });
  document.body.append(box);
  box.showModal();
  input.focus();
}

/** Asks for the token. Simultaneous calls share one question. Cancelled: none was entered. */
export function askToken(refused: boolean): Promise<void> {
  asked ??= new Promise<void>((resolve, reject) => {
    const given = (words: string): void => {
      keep(words);
      resolve();
    };
    openDialog(refused, given, () => reject(new Cancelled('No token was given.')));
  }).finally(() => (asked = null));
  return asked;
}
