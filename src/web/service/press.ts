// SPDX-License-Identifier: Apache-2.0
/** A press of the mouse, a finger or a pen: a page that moves under it loses the click. */

let ended: Promise<void> | null = null;

addEventListener('pointerdown', () => {
  ended ??= new Promise((resolve) => {
    const end = (): void => {
      removeEventListener('pointerup', end, true);
      removeEventListener('pointercancel', end, true);
      ended = null;
      setTimeout(resolve); // the click follows the release in the same task
    };
    addEventListener('pointerup', end, true);
    addEventListener('pointercancel', end, true);
  });
}, true);

/** Resolves when nothing is pressed any more and the click of the last press is handled. */
export const pressEnded = (): Promise<void> => ended ?? Promise.resolve();
