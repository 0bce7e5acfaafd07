// SPDX-License-Identifier: Apache-2.0
import { button, el, text } from '../dom';

/** Asks before something is done that cannot be undone: true if it is to be done. */
export function confirmed(question: string, consequence: string, action: string): Promise<boolean> {
  return new Promise((resolve) => {
    let yes = false;
    const act = button(
      action,
      () => {
        yes = true;
        box.close();
      },
      { class: 'danger' },
    );
    const stay = button('Cancel', () => box.close());
    const box = el(
      'dialog',
      { 'aria-labelledby': 'question', 'aria-describedby': 'consequence' },
      el('h2', { id: 'question' }, question),
      el('p', { id: 'consequence' }, consequence),
      el('div', { class: 'actions' }, stay, act),
    );
    box.addEventListener('close', () => {
      box.remove();
      resolve(yes);
    });
    document.body.append(box);
    box.showModal();
    stay.focus();
  });
}

/** Shows text to copy where the clipboard may not be written to. */
export function showText(title: string, content: string): void {
  const input = el('input', { type: 'text', readonly: '', 'aria-labelledby': 'shown-title' });
  input.value = content;
  const box = el(
    'dialog',
    { 'aria-labelledby': 'shown-title' },
    el('h2', { id: 'shown-title' }, title),
    text('It is selected: copy it with Ctrl+C.', 'quiet'),
    input,
    el(
      'div',
      { class: 'actions' },
      button('Close', () => box.close()),
    ),
  );
  box.addEventListener('close', () => box.remove());
  document.body.append(box);
  box.showModal();
  input.select();
}
