// SPDX-License-Identifier: Apache-2.0
/** The frame of a report: header, contents, the choice of a model, and the sections. */

import { append, choice, el } from './dom';
import { startTheme, themeButton } from './theme';
import type { Fit } from './types';

/** What a report puts into the frame. */
export interface Content {
  /** What the page is, "Pendulum report". */
  kind: string;
  title: string;
  heading: string;
  facts: string;
  models: readonly Pick<Fit, 'model' | 'status'>[];
  recommended: string | null | undefined;
  shown: number;
  /** Another model shall be shown. */
  show: (index: number) => void;
  /** The sections anew; `changed` is to be called when headings change later. */
  sections: (changed: () => void) => HTMLElement[];
}

function header({ kind, heading, facts }: Content): HTMLElement {
  const words = el(
    'div',
    {},
    el('p', { class: 'kind' }, kind),
    el('h1', {}, heading),
    el('p', { class: 'quiet' }, facts),
  );
  return el('header', {}, words, themeButton());
}

/** The contents, from the headings that are there. */
function contents(parts: HTMLElement): HTMLElement {
  const list = el('ol');
  for (const part of parts.querySelectorAll('section')) {
    list.append(el('li', {}, el('a', { href: `#${part.id}` }, part.querySelector('h2')?.firstChild?.textContent ?? part.id)));
  }
  return el('nav', { 'aria-label': 'Contents' }, list);
}

/** Which of several fits is shown in detail. */
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
  const group = choice('Model shown', options, String(shown), (value) => change(Number(value)));
  group.classList.add('models');
  return group;
}

/** Replaces the children of an element; what is looked at stays where it is. */
export function refill(element: HTMLElement, children: HTMLElement[]): void {
  const top = window.scrollY;
  element.replaceChildren(...children);
  window.scrollTo({ top });
}

/** Contents beside the choice of a model and the sections, which go into `main` after what is there. */
export function reportColumns(content: Content, main: HTMLElement): HTMLElement {
  const parts = el('div');
  const navigation = el('div', { class: 'side' });
  const changed = (): void => navigation.replaceChildren(contents(parts));
  parts.append(...content.sections(changed));
  changed();
  const chooser = modelChooser(content, (index) => {
    content.show(index);
    refill(parts, content.sections(changed));
    changed();
  });
  append(main, [chooser, parts]);
  return el('div', { class: 'columns' }, navigation, main);
}

/** Fills `root` with the report. */
export function fillPage(root: HTMLElement, content: Content): void {
  startTheme();
  document.title = `${content.title} – ${content.kind.toLowerCase()}`;
  const skip = el('a', { class: 'skip', href: '#main' }, 'Skip to the report');
  const columns = reportColumns(content, el('main', { id: 'main', class: 'report' }));
  root.replaceChildren(el('div', { class: 'page' }, skip, header(content), columns));
}
