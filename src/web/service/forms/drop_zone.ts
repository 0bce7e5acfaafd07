// SPDX-License-Identifier: Apache-2.0
/** A button to choose files, onto which files can also be dropped. */

import { el } from '../../shared/dom';

export interface DropZone {
  element: HTMLElement;
  button: HTMLButtonElement;
}

/** Calls `take` with chosen files, and with files dropped anywhere on the page while the view is shown. */
export function dropZone(words: string, hint: string, take: (files: File[]) => void, signal: AbortSignal): DropZone {
  const input = el('input', { type: 'file', multiple: '', hidden: '', accept: '.csv,.txt,.tsv,.dat,.log,.zip,.mat,.xlsx,.xls,.ods,.json,.npz,.npy,.phyphox,text/*' });
  const zone = el(
    'button',
    { type: 'button', class: 'drop' },
    el('span', { class: 'drop-words' }, words),
    el('span', { class: 'drop-hint' }, hint),
  );
  zone.addEventListener('click', () => input.click());
  input.addEventListener('change', () => {
    const files = [...(input.files ?? [])];
    input.value = '';
    if (files.length > 0) take(files);
  });
  const over = (on: boolean) => (event: DragEvent) => {
    if (!event.dataTransfer?.types.includes('Files')) return;
    event.preventDefault();
    zone.classList.toggle('over', on);
  };
  document.addEventListener('dragover', over(true), { signal });
  document.addEventListener('dragleave', (event) => event.relatedTarget === null && over(false)(event), { signal });
  document.addEventListener(
    'drop',
    (event) => {
      over(false)(event);
      const files = [...(event.dataTransfer?.files ?? [])];
      if (files.length > 0) take(files);
    },
    { signal },
  );
  return { element: el('div', {}, zone, input), button: zone };
}
