// SPDX-License-Identifier: Apache-2.0
import { button, el, text } from '../shared/dom';

/** Asks before an action that cannot be undone. True if the user confirms. */
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

/** Shows text to copy by hand, if the page may not write to the clipboard. */
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
