// SPDX-License-Identifier: Apache-2.0
/** A button to choose files. Files can also be dropped or pasted anywhere on the page. */

import { el } from '../../shared/dom';

export interface DropZone {
  element: HTMLElement;
  button: HTMLButtonElement;
}

/** The file of a pasted text, unless it was pasted into a field. */
function pastedFile(event: ClipboardEvent): File | null {
  const isField = event.target instanceof Element && event.target.closest('input, textarea, select') !== null;
  const words = event.clipboardData?.getData('text/plain') ?? '';
  return isField || words.trim() === '' ? null : new File([words], 'pasted numbers', { type: 'text/csv' });
}

/** Calls `take` with chosen files, and with files dropped or pasted on the page while the view is shown. */
export function dropZone(words: string, hint: string, take: (files: File[]) => void, signal: AbortSignal): DropZone {
  const input = el('input', { type: 'file', multiple: '', hidden: '', accept: '.csv,.txt,.tsv,.dat,.log,.lvm,.mot,.zip,.mat,.xlsx,.xls,.ods,.fods,.json,.npz,.npy,.phyphox,text/*' });
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
  document.addEventListener(
    'paste',
    (event) => {
      const pasted = [...(event.clipboardData?.files ?? [])];
      const file = pastedFile(event);
      if (pasted.length > 0) take(pasted);
      else if (file) take([file]);
    },
    { signal },
  );
  return { element: el('div', {}, zone, input), button: zone };
}
