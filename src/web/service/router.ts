// SPDX-License-Identifier: Apache-2.0
/** Shows the view of an address without loading the page again. */

import { el, text } from '../shared/dom';
import { parseRoute, type Route } from './routes';
import { makeShell, type Place, type Shell, type View } from './shell';
import { alertPlace, showProblem } from './views/problem_view';

const kName = 'Pendulum';

let shell: Shell | null = null;
let views: (route: Route) => View = () => missing;
let life = new AbortController();
let shown = '';

export const missing: View = ({ main, name }) => {
  name('There is nothing at this address');
  main.append(
    text('The address may be mistyped, or what was here may have been deleted.'),
    el('a', { href: '/' }, 'Start'),
  );
};

function makePlace({ main, say }: Shell, signal: AbortSignal): Place {
  const heading = el('h1', { tabindex: '-1' });
  main.replaceChildren(heading);
  const name = (words: string): void => {
    if (signal.aborted) return;
    heading.textContent = words;
    document.title = `${words} – ${kName}`;
  };
  return { main, signal, name, say };
}

async function show(moved: boolean): Promise<void> {
  if (!shell) return;
  shown = location.pathname + location.search;
  life.abort();
  life = new AbortController();
  const { signal } = life;
  const route = parseRoute(location.pathname, location.search);
  shell.mark(route);
  shell.say('');
  const place = makePlace(shell, signal);
  const problems = alertPlace();
  try {
    const made = views(route)(place);
    if (moved) {
      window.scrollTo({ top: 0 });
      place.main.querySelector('h1')?.focus({ preventScroll: true });
    }
    await made;
  } catch (error) {
    if (signal.aborted) return;
    place.main.append(problems);
    showProblem(problems, error, () => void show(true));
  }
}

/** Goes to an address of the page. `replace`: the current address is removed from the history. */
export function go(path: string, replace = false): void {
  if (replace) history.replaceState(null, '', path);
  else history.pushState(null, '', path);
  void show(true);
}

/** Makes the current view again after a change. */
export const again = (): void => void show(true);

/** The address of this page that a click on a link leads to; null for any other click. */
function pathOfClick(event: MouseEvent): string | null {
  const anchor = event.target instanceof Element ? event.target.closest('a') : null;
  if (!anchor || event.defaultPrevented || event.button !== 0) return null;
  if (event.metaKey || event.ctrlKey || event.shiftKey || event.altKey) return null;
  if (anchor.target !== '' || anchor.hasAttribute('download') || anchor.origin !== location.origin) return null;
  const samePage = anchor.pathname + anchor.search === location.pathname + location.search;
  if (samePage && anchor.hash !== '') return null;
  if (parseRoute(anchor.pathname).page === 'missing') return null;
  return anchor.pathname + anchor.search;
}

/** Shows the view of the address, now and after every change. */
export function startRouter(root: HTMLElement, choose: (route: Route) => View): void {
  shell = makeShell(root);
  views = choose;
  document.addEventListener('click', (event) => {
    const path = pathOfClick(event);
    if (path === null) return;
    event.preventDefault();
    go(path);
  });
  window.addEventListener('popstate', () => {
    if (location.pathname + location.search !== shown) void show(true);
  });
  void show(false);
}
