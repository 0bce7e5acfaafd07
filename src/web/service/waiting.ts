// SPDX-License-Identifier: Apache-2.0
/** A visible pause with a countdown and a button to cancel it. */

import { button, el } from '../shared/dom';
import { Cancelled, type Problem } from './server/problem';

let place: HTMLElement | null = null;

/** The element that shows pauses. It is always in the page. */
export function waitingPlace(): HTMLElement {
  place = el('div', { class: 'waiting-place' });
  return place;
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
