// SPDX-License-Identifier: Apache-2.0
import { save } from '../shared/save';
import { ask } from './server/api';

/** Saves an answer of the service. A plain link cannot send the token. */
export async function download(path: string, name: string, signal: AbortSignal): Promise<void> {
  const answer = await ask(path, { signal });
  save(await answer.blob(), name);
}

/** The name of a recording without its extension, with only characters that a file name may have. */
export function stem(name: string): string {
  const bare = name.replace(/\.[A-Za-z0-9]{1,5}$/, '').replace(/[^\p{L}\p{N}._-]+/gu, '_');
  return bare.replace(/^[._]+|_+$/g, '').slice(0, 80) || 'fit';
}
