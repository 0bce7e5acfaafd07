// SPDX-License-Identifier: Apache-2.0
/** The frame of a report: header, contents, the choice of a model, and the sections. */

import { append, choice, el } from './dom';
import type { Fit } from './result_types';
import { startTheme, themeButton } from './theme';

/** The content of a page. */
export interface Content {
  /** Kind of the page, such as "Pendulum report". */
  kind: string;
  title: string;
  heading: string;
  facts: string;
  models: readonly Pick<Fit, 'model' | 'status'>[];
  recommended: string | null | undefined;
  shown: number;
  /** Selects the model with this index. */
  show: (index: number) => void;
  /** Makes the sections of the selected model. They call `changed` when their headings change later. */
  sections: (changed: () => void) => HTMLElement[];
}

function header({ kind, heading, facts }: Content): HTMLElement {
  const title = el('div', { class: 'title-line' }, el('h1', {}, heading), el('p', { class: 'quiet' }, facts));
  return el('header', {}, el('div', {}, el('p', { class: 'kind' }, kind), title), themeButton());
}

/** Table of contents, made from the headings in `parts`. */
function contents(parts: HTMLElement): HTMLElement {
  const list = el('ol');
  for (const part of parts.querySelectorAll('section')) {
    list.append(el('li', {}, el('a', { href: `#${part.id}` }, part.querySelector('h2')?.firstChild?.textContent ?? part.id)));
  }
  return el('nav', { 'aria-label': 'Contents' }, list);
}

/** Radio buttons for the model that is shown; null with fewer than two models. */
function modelChooser({ models, recommended, shown }: Content, change: (index: number) => void): HTMLElement | null {
  if (models.length < 2) return null;
  const options = models.map((fit, i) => {
    const remark =
      fit.model === recommended
        ? ' (recommended)'
        : fit.status === 'converged'
          ? ''
          : ` (${fit.status.replace(/_/g, ' ')})`;
    return { value: String(i), label: fit.model + remark };
  });
  const group = choice('Law shown', options, String(shown), (value) => change(Number(value)));
  group.classList.add('models');
  return group;
}

/** Replaces the children of an element without changing the scroll position. */
export function refill(element: HTMLElement, children: HTMLElement[]): void {
  const top = window.scrollY;
  element.replaceChildren(...children);
  window.scrollTo({ top });
}

/**
 * Appends the sections to `main`, with the model chooser after the first one. Returns `main` with the table of contents
 * beside it.
 */
export function reportColumns(content: Content, main: HTMLElement): HTMLElement {
  const [first, others] = [el('div'), el('div')];
  const navigation = el('div', { class: 'side' });
  const changed = (): void => navigation.replaceChildren(contents(main));
  const fill = (): void => {
    const [answer, ...rest] = content.sections(changed);
    refill(first, [answer]);
    refill(others, rest);
  };
  const chooser = modelChooser(content, (index) => {
    content.show(index);
    fill();
    changed();
  });
  append(main, [first, chooser, others]);
  fill();
  changed();
  return el('div', { class: 'columns' }, navigation, main);
}

/** Fills `root` with the whole page. */
export function fillPage(root: HTMLElement, content: Content): void {
  startTheme();
  document.title = `${content.title} – ${content.kind.toLowerCase()}`;
  const skip = el('a', { class: 'skip', href: '#main' }, 'Skip to the report');
  const columns = reportColumns(content, el('main', { id: 'main', class: 'report' }));
  root.replaceChildren(el('div', { class: 'page' }, skip, header(content), columns));
}
