// SPDX-License-Identifier: Apache-2.0
/** Visible waiting: a pause with a countdown, or work with the time it has taken; each with a button to cancel it. */

import { button, el } from '../shared/dom';
import { Cancelled, type Problem } from './server/problem';

let place: HTMLElement | null = null;

/** The element that shows pauses. It is always in the page. */
export function waitingPlace(): HTMLElement {
  place = el('div', { class: 'waiting-place' });
  return place;
}

const kQuiet = 2; // s that work may take before the page shows it

/** "8 s", "2 min 5 s" */
export function durationWords(seconds: number): string {
  const whole = Math.round(seconds);
  return whole < 60 ? `${whole} s` : `${Math.floor(whole / 60)} min ${whole % 60} s`;
}

/**
 * Does work that may take long. After two seconds the page shows what it does and for how long, with a button that
 * cancels it. Cancelled: by the user; the signal of the work is aborted then.
 */
export async function whileBusy<T>(
  words: string,
  work: (signal: AbortSignal) => Promise<T>,
  signal?: AbortSignal,
): Promise<T> {
  const ended = new AbortController();
  const both = signal ? AbortSignal.any([signal, ended.signal]) : ended.signal;
  const began = performance.now();
  const spent = el('span', { 'aria-hidden': 'true' });
  const cancel = button('Cancel', () => ended.abort(new Cancelled(`${words}: cancelled.`)));
  const box = el('div', { class: 'notice busy' }, el('p', { role: 'status' }, `${words} …`), spent, cancel);
  const tell = (): void => {
    const seconds = (performance.now() - began) / 1000;
    if (seconds < kQuiet) return;
    spent.textContent = durationWords(seconds);
    if (!box.isConnected) place?.append(box);
  };
  const timer = setInterval(tell, 500);
  try {
    return await work(both);
  } finally {
    clearInterval(timer);
    box.remove();
  }
}

/** Resolves after this number of seconds. Rejects when the signal is aborted. */
export function pause(seconds: number, signal?: AbortSignal): Promise<void> {
  return new Promise((resolve, reject) => {
    const stop = (): void => {
      clearTimeout(timer);
      reject(signal?.reason);
    };
    const timer = setTimeout(() => {
      signal?.removeEventListener('abort', stop);
      resolve();
    }, 1000 * seconds);
    if (signal?.aborted) stop();
    else signal?.addEventListener('abort', stop, { once: true });
  });
}

/** Shows the problem and counts down to the next attempt. Cancelled: by the user. */
export async function waitFor(problem: Problem, seconds: number, signal?: AbortSignal): Promise<void> {
  const ended = new AbortController();
  const both = signal ? AbortSignal.any([signal, ended.signal]) : ended.signal;
  const left = el('span', { 'aria-hidden': 'true' });
  const said = `${problem.title}. ${problem.detail} It is tried again in ${seconds} s.`;
  const cancel = button('Cancel', () => ended.abort(new Cancelled('Cancelled.')));
  const box = el('div', { class: 'notice' }, el('p', { role: 'status' }, said), left, cancel);
  place?.append(box);
  try {
    for (let rest = seconds; rest > 0; --rest) {
      left.textContent = `${rest} s`;
      await pause(1, both);
    }
  } finally {
    box.remove();
  }
}
