// SPDX-License-Identifier: Apache-2.0
/** Hands recordings to the service. */

import type { Loose, Result } from '../types';
import { ask, formBody, newKey } from './api';
import { ProblemError } from './problem';
import { batchPath, fitApi, fitPath, idOfLocation } from './routes';
import type { Flags } from './types';

/** What belongs to recordings: flags, and JSON text of rig and calibration. */
export interface Choices {
  flags: Flags;
  rig: string | null;
  calibration: string | null;
}

export interface Recording {
  name: string;
  content: Blob;
}

/** A request that can be sent again and counts once. */
interface Submission {
  path: string;
  body: Blob | string;
  headers: Record<string, string>;
}

const results = new Map<string, Result>();

/** The result of a fit that this page has just made, else null; it is given once. */
export function freshResult(id: string): Result | null {
  const result = results.get(id) ?? null;
  results.delete(id);
  return result;
}

const withFlags = (path: string, flags: Flags): string => {
  const query = new URLSearchParams(flags).toString();
  return query === '' ? path : `${path}?${query}`;
};

/** The request for one recording, or for several as a batch. */
export async function submission(recordings: Recording[], { flags, rig, calibration }: Choices): Promise<Submission> {
  const form = new FormData();
  for (const { name, content } of recordings) form.append('data', content, name);
  const json = (text: string): Blob => new Blob([text], { type: 'application/json' });
  if (rig !== null) form.append('rig', json(rig), 'rig.json');
  if (calibration !== null) form.append('calibration', json(calibration), 'calibration.json');
  const { body, type } = await formBody(form);
  const path = withFlags(recordings.length === 1 ? '/v1/fits' : '/v1/batches', flags);
  return { path, body, headers: { 'Content-Type': type, 'Idempotency-Key': newKey() } };
}

async function sentFit({ path, body, headers }: Submission, signal?: AbortSignal): Promise<string> {
  const answer = await ask(path, { method: 'POST', body, headers, signal });
  const id = idOfLocation(answer.headers.get('Location'));
  if (id === null) {
    throw new ProblemError({
      title: 'An answer without an address',
      status: answer.status,
      detail: 'The service fitted the recording and did not say where.',
      code: 'bad_answer',
    });
  }
  results.set(id, (await answer.json()) as Result);
  return fitPath(id);
}

/** Sends it; the address of the page of the new fit, or of the batch. */
export async function sent(what: Submission, signal?: AbortSignal): Promise<string> {
  if (!what.path.startsWith('/v1/batches')) return sentFit(what, signal);
  const answer = await ask(what.path, { method: 'POST', body: what.body, headers: what.headers, signal });
  const id = idOfLocation(answer.headers.get('Location')) ?? ((await answer.json()) as { id: string }).id;
  return batchPath(id);
}

/** The rig and the calibration that replace those of a fit; undefined: they stay. */
export interface Replaced {
  rig?: Loose | null;
  calibration?: Loose | null;
}

/** Fits a recording once more, with these flags in place of its own (an empty one takes one away); the new fit's address. */
export function refitted(id: string, flags: Flags, replaced: Replaced, signal?: AbortSignal): Promise<string> {
  const path = fitApi(id, 'refits');
  const key = { 'Idempotency-Key': newKey() };
  if (replaced.rig === undefined && replaced.calibration === undefined)
    return sentFit({ path: withFlags(path, flags), body: '', headers: key }, signal);
  const headers = { ...key, 'Content-Type': 'application/json' };
  return sentFit({ path, body: JSON.stringify({ options: flags, ...replaced }), headers }, signal);
}
