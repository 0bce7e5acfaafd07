// SPDX-License-Identifier: Apache-2.0
/** Where the user guide explains a warning. */

import { el } from './dom';

/** Address of the guide's folder; null in a file, which may be read where no guide is. */
let folder: string | null = null;

/** For the page of a server that has the guide, or says how to get it. */
export function guideAt(address: string): void {
  folder = address;
}

/** The place in the guide that explains a warning: a link if the guide's address is known. */
export function placeInGuide(code: string): HTMLElement {
  const words = `Guide: Reference, ${code}`;
  const place = folder === null ? words : el('a', { href: `${folder}reference.html#${code}` }, words);
  return el('small', { class: 'quiet' }, place);
}

/** The places of several warnings; null if there are none. */
export const placesInGuide = (codes: string[]): HTMLElement | null =>
  codes.length === 0 ? null : el('p', {}, ...[...new Set(codes)].flatMap((code) => [placeInGuide(code), ' ']));
