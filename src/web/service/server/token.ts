// SPDX-License-Identifier: Apache-2.0
/** The token of the service. The page asks for it if it is missing or wrong, and keeps it until the tab is closed. */

import { button, el, text } from '../../shared/dom';
import { Cancelled } from './problem';

const kKey = 'pendulum_token';
let asked: Promise<void> | null = null;

/** Empty if none was entered. */
export const token = (): string => sessionStorage.getItem(kKey) ?? '';

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
      sessionStorage.setItem(kKey, words);
      resolve();
    };
    openDialog(refused, given, () => reject(new Cancelled('No token was given.')));
  }).finally(() => (asked = null));
  return asked;
}
