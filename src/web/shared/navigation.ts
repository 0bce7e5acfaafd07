// SPDX-License-Identifier: Apache-2.0
/** Zooms and moves a time range by buttons, keys, fingers and mouse, the same for all plots of a view. */

import type { Chart } from './chart';
import { button, el } from './dom';
import type { TimeView } from './time_view';

const kZoom = 0.5;
const kStep = 0.25; // of the visible width

const kKeys: Record<string, (view: TimeView) => void> = {
  '+': (view) => view.zoom(kZoom),
  '=': (view) => view.zoom(kZoom),
  '-': (view) => view.zoom(1 / kZoom),
  _: (view) => view.zoom(1 / kZoom),
  ArrowLeft: (view) => view.pan(-kStep),
  ArrowRight: (view) => view.pan(kStep),
  '0': (view) => view.reset(),
};

function onKey(event: KeyboardEvent, view: TimeView): void {
  if (event.ctrlKey || event.metaKey || event.altKey || event.target !== event.currentTarget) return;
  const act = kKeys[event.key];
  if (!act) return;
  event.preventDefault();
  act(view);
}

/** Labels of the buttons of a view. */
export interface NavigationWords {
  group: string;
  back: string;
  on: string;
  all: string;
}

const kTimeWords: NavigationWords = {
  group: 'Time shown',
  back: 'Earlier',
  on: 'Later',
  all: 'Show the whole recording (0)',
};

/** Buttons for a view. "Show all" is disabled while everything is visible. */
export function navigationButtons(view: TimeView, words = kTimeWords): HTMLElement {
  const all = button('Show all', () => view.reset(), { title: words.all });
  const shows = (): void => void all.toggleAttribute('disabled', view.whole);
  view.onChange(shows);
  shows();
  return el(
    'div',
    { class: 'buttons', role: 'group', 'aria-label': words.group },
    button('−', () => view.zoom(1 / kZoom), { 'aria-label': 'Zoom out', title: 'Zoom out (−)' }),
    button('+', () => view.zoom(kZoom), { 'aria-label': 'Zoom in', title: 'Zoom in (+)' }),
    button('◂', () => view.pan(-kStep), { 'aria-label': words.back, title: `${words.back} (←)` }),
    button('▸', () => view.pan(kStep), { 'aria-label': words.on, title: `${words.on} (→)` }),
    all,
  );
}

/** A box around linked plots that handles the keys. */
export function keyboardBox(label: string, view: TimeView, ...children: Node[]): HTMLElement {
  const box = el('div', {
    class: 'linked',
    tabindex: '0',
    role: 'group',
    'aria-label': `${label}. Keys: plus and minus zoom, left and right arrow move, 0 shows all.`,
  });
  box.append(...children);
  box.addEventListener('keydown', (event) => onKey(event, view));
  return box;
}

/** Ctrl and the wheel zoom, Shift and dragging (or one finger) moves, a double click shows all. */
export function followPointer(chart: Chart, view: TimeView): void {
  let held: number | null = null;
  chart.host.addEventListener(
    'wheel',
    (event) => {
      if (!event.ctrlKey && !event.metaKey) return;
      event.preventDefault();
      const left = chart.over?.getBoundingClientRect().left ?? 0;
      view.zoom(event.deltaY < 0 ? 0.8 : 1.25, chart.xAt(event.clientX - left));
    },
    { passive: false },
  );
  chart.host.addEventListener('dblclick', () => view.reset());
  chart.host.addEventListener('pointerdown', (event) => {
    if (event.pointerType === 'mouse' && !event.shiftKey) return;
    held = event.clientX;
    chart.host.setPointerCapture(event.pointerId);
  });
  chart.host.addEventListener('mousedown', (event) => event.shiftKey && event.stopPropagation(), { capture: true });
  chart.host.addEventListener('pointermove', (event) => {
    if (held === null) return;
    view.pan((held - event.clientX) / (chart.over?.clientWidth || 1));
    held = event.clientX;
  });
  for (const end of ['pointerup', 'pointercancel'] as const) chart.host.addEventListener(end, () => (held = null));
}
