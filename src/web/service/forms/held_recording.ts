// SPDX-License-Identifier: Apache-2.0
/** Keeps the recording of the start page until the tab is closed, so that it survives a reload. */

import { keep, kept } from '../../shared/kept';
import type { Recording } from './submit';

const kName = 'pendulum_recording_name';
const kContent = 'pendulum_recording';
const kText = 't';
const kBinary = 'b';

/** The largest number of characters that are kept. Browsers give a page about five million for everything. */
export const kMostKept = 4_000_000;

/** The bytes of a text with one character for each byte. */
const bytesOf = (binary: string): Uint8Array<ArrayBuffer> => Uint8Array.from(binary, (character) => character.charCodeAt(0));

function encoded(bytes: Uint8Array): string {
  try {
    return kText + new TextDecoder('utf-8', { fatal: true, ignoreBOM: true }).decode(bytes);
  } catch {
    let binary = '';
    for (const byte of bytes) binary += String.fromCharCode(byte);
    return kBinary + btoa(binary);
  }
}

/** Keeps a recording in the place of the one before. Returns whether it could be kept. */
export async function holdRecording({ name, content }: Recording): Promise<boolean> {
  forgetRecording();
  if (content.size > kMostKept) return false;
  const words = encoded(new Uint8Array(await content.arrayBuffer()));
  if (words.length > kMostKept) return false;
  keep('closed', kName, name);
  keep('closed', kContent, words);
  return kept('closed', kContent) !== null;
}

export function forgetRecording(): void {
  keep('closed', kName, '');
  keep('closed', kContent, '');
}

/** The recording that was kept; null if there is none. */
export function heldRecording(): Recording | null {
  const [name, words] = [kept('closed', kName), kept('closed', kContent)];
  if (name === null || words === null) return null;
  const content = words.startsWith(kText) ? words.slice(1) : bytesOf(atob(words.slice(1)));
  return { name, content: new Blob([content]) };
}
