// SPDX-License-Identifier: Apache-2.0
import { append, el, type Child } from './dom';

/** A part of the report under a heading; `id` is what the contents link to. */
export function section(id: string, title: string, ...children: Child[]): HTMLElement {
  const element = el('section', { id, 'aria-labelledby': `${id}-title` }, el('h2', { id: `${id}-title` }, title));
  append(element, children);
  return element;
}

/** A plot with what belongs to it: controls above, words below. */
export function figure(caption: Child, plot: Node, ...above: Child[]): HTMLElement {
  const element = el('figure');
  append(element, above);
  element.append(plot, el('figcaption', {}, caption));
  return element;
}

/** Paragraph in place of what cannot be shown, and why. */
export const absent = (why: string): HTMLElement => el('p', { class: 'absent' }, why);
