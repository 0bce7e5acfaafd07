// SPDX-License-Identifier: Apache-2.0
/** The frame of all views: navigation, theme button, and the element for the view. */

import { el, text } from '../shared/dom';
import { startTheme, themeButton } from '../shared/theme';
import { inviteButton } from './invite';
import { parseRoute, type Route } from './routes';
import { waitingPlace } from './waiting';

/** What a view gets from the frame. */
export interface Place {
  main: HTMLElement;
  /** Aborted when the user leaves the view. */
  signal: AbortSignal;
  /** Sets the heading and the title of the window. */
  name: (words: string) => void;
  /** Announces a text to screen readers without moving the focus. */
  say: (words: string) => void;
}

export type View = (place: Place) => void | Promise<void>;

const kLinks: [string, string][] = [
  ['/', 'New fit'],
  ['/fits', 'Past fits'],
  ['/calibration', 'Calibration'],
  ['/live', 'Live'],
];

export interface Shell {
  main: HTMLElement;
  say: (words: string) => void;
  /** Marks the link of the current view. */
  mark: (route: Route) => void;
}

function links(): { element: HTMLElement; mark: (route: Route) => void } {
  const list = el('ul');
  const anchors = kLinks.map(([href, label]) => {
    const anchor = el('a', { href }, label);
    list.append(el('li', {}, anchor));
    return anchor;
  });
  const mark = (route: Route): void =>
    anchors.forEach((anchor) => {
      const own = parseRoute(anchor.pathname).page === route.page;
      if (own) anchor.setAttribute('aria-current', 'page');
      else anchor.removeAttribute('aria-current');
    });
  return { element: el('nav', { class: 'site', 'aria-label': 'Site' }, list), mark };
}

/** Fills `root` with the frame. */
export function makeShell(root: HTMLElement): Shell {
  startTheme();
  const { element, mark } = links();
  const main = el('main', { id: 'main', tabindex: '-1' });
  const said = el('p', { class: 'unseen', role: 'status' });
  const header = el(
    'header',
    { class: 'top' },
    el('a', { class: 'brand', href: '/' }, 'Pendulum'),
    element,
    themeButton(),
  );
  const skip = el('a', { class: 'skip', href: '#main' }, 'Skip to the content');
  const footer = el(
    'footer',
    { class: 'foot' },
    text('Moment of inertia and friction of a pendulum, with error bars, from a recording of its free swing.', 'quiet'),
    inviteButton(),
  );
  root.replaceChildren(el('div', { class: 'page service' }, skip, header, waitingPlace(), main, said, footer));
  const say = (words: string): void => {
    said.textContent = words;
  };
  return { main, say, mark };
}
