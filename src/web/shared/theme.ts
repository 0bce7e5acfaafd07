// SPDX-License-Identifier: Apache-2.0
/** Light or dark theme, as the system says or the user chooses; always light when printed. */

import { button } from './dom';
import { keep, kept } from './kept';

type Theme = 'light' | 'dark';

const kKept = 'pendulum_theme';
const listeners = new Set<() => void>();
const dark = (): MediaQueryList => window.matchMedia('(prefers-color-scheme: dark)');
let chosen: Theme | null = null;
let onPaper = false;
let started = false;

const wanted = (): Theme => (onPaper ? 'light' : (chosen ?? (dark().matches ? 'dark' : 'light')));

function apply(): void {
  document.documentElement.dataset.theme = wanted();
  for (const listener of listeners) listener();
}

/** Calls `listener` when the colours or the medium change. Returns a function that stops this. */
export function onThemeChange(listener: () => void): () => void {
  listeners.add(listener);
  return () => listeners.delete(listener);
}

/** Whether the page is being printed. */
export const printing = (): boolean => onPaper;

function setPaper(now: boolean): void {
  if (now === onPaper) return;
  onPaper = now;
  apply();
}

function keptTheme(): Theme | null {
  const words = kept('cleared', kKept);
  return words === 'light' || words === 'dark' ? words : null;
}

/** Follows the theme of the system, and printing, from now on. Further calls only apply the theme. */
export function startTheme(): void {
  if (started) return apply();
  started = true;
  chosen = keptTheme();
  dark().addEventListener('change', apply);
  window.matchMedia('print').addEventListener('change', (event) => setPaper(event.matches));
  window.addEventListener('beforeprint', () => setPaper(true));
  window.addEventListener('afterprint', () => setPaper(false));
  apply();
}

/** The button that changes the theme. */
export function themeButton(): HTMLButtonElement {
  const label = (): string => (wanted() === 'dark' ? 'Light' : 'Dark');
  const element = button(
    label(),
    () => {
      chosen = wanted() === 'dark' ? 'light' : 'dark';
      keep('cleared', kKept, chosen);
      apply();
    },
    { class: 'theme', title: 'Change between light and dark' },
  );
  onThemeChange(() => {
    if (!onPaper) element.textContent = label();
  });
  return element;
}

/** Calls `draw` with the colours of the light theme, for pictures that leave the page. */
export function onWhite<T>(draw: () => T): T {
  const { dataset } = document.documentElement;
  const { theme } = dataset;
  dataset.theme = 'light';
  try {
    return draw();
  } finally {
    dataset.theme = theme;
  }
}

/** A colour of style.css: colour("ink") is the value of --ink. */
export function colour(name: string): string {
  return getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim() || '#888';
}
