// SPDX-License-Identifier: Apache-2.0
import { append, el, type Child } from './dom';

/** A section with its heading. The table of contents links to `id`. */
export function section(id: string, title: string, ...children: Child[]): HTMLElement {
  const element = el('section', { id, 'aria-labelledby': `${id}-title` }, el('h2', { id: `${id}-title` }, title));
  append(element, children);
  return element;
}

/** A plot with controls above and a caption below. */
export function figure(caption: Child, plot: Node, ...above: Child[]): HTMLElement {
  const element = el('figure');
  append(element, above);
  element.append(plot, el('figcaption', {}, caption));
  return element;
}

/** A paragraph that says why something cannot be shown. */
export const absent = (why: string): HTMLElement => el('p', { class: 'absent' }, why);
