// SPDX-License-Identifier: Apache-2.0
/** A dialog that asks for the name of a fit. */

import { button, el, text } from '../../shared/dom';

const kLongestName = 200; // characters, as in the service

/** The new name, empty for that of the file; null if the user cancels. */
export function askName(name: string, file: string): Promise<string | null> {
  return new Promise((resolve) => {
    let chosen: string | null = null;
    const input = el('input', { type: 'text', id: 'fit-name', maxlength: String(kLongestName), autocomplete: 'off' });
    input.value = name;
    const form = el(
      'form',
      { method: 'dialog' },
      el('h2', { id: 'rename-title' }, 'Rename this fit'),
      el('label', { for: 'fit-name' }, 'Name'),
      input,
      text(`An empty name brings back that of the file, ${file}.`, 'quiet'),
      el(
        'div',
        { class: 'actions' },
        button('Cancel', () => box.close()),
        el('button', { type: 'submit', class: 'primary' }, 'Rename'),
      ),
    );
    const box = el('dialog', { 'aria-labelledby': 'rename-title' }, form);
    form.addEventListener('submit', () => (chosen = input.value.trim()));
    box.addEventListener('close', () => {
      box.remove();
      resolve(chosen);
    });
    document.body.append(box);
    box.showModal();
    input.select();
  });
}
