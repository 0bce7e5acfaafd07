// SPDX-License-Identifier: Apache-2.0
/** Sends recordings to the service. */

import type { Loose, Result } from '../../shared/result_types';
import { batchPath, fitApi, fitPath, idOfLocation } from '../routes';
import { ask, askJson, formBody, newKey } from '../server/api';
import { ProblemError } from '../server/problem';
import type { Flags, Preview } from '../types';

/** Options of a fit: flags, and JSON text of rig and calibration. */
export interface Choices {
  flags: Flags;
  rig: string | null;
  calibration: string | null;
}

export interface Recording {
  name: string;
  content: Blob;
}

/** A request that can be repeated: the service makes only one fit of it. */
interface Submission {
  path: string;
  body: Blob | string;
  headers: Record<string, string>;
}

const results = new Map<string, Result>();

/** The result of a fit that this page has just requested, else null. Only the first call returns it. */
export function freshResult(id: string): Result | null {
  const result = results.get(id) ?? null;
  results.delete(id);
  return result;
}

const withFlags = (path: string, flags: Flags): string => {
  const query = new URLSearchParams(flags).toString();
  return query === '' ? path : `${path}?${query}`;
};

/** The recordings and files of a request as one body. */
async function bodyOf(recordings: Recording[], { rig, calibration }: Choices): Promise<{ body: Blob; type: string }> {
  const form = new FormData();
  for (const { name, content } of recordings) form.append('data', content, name);
  const json = (text: string): Blob => new Blob([text], { type: 'application/json' });
  if (rig !== null) form.append('rig', json(rig), 'rig.json');
  const isTable = calibration !== null && !calibration.trimStart().startsWith('{');
  if (calibration !== null) form.append('calibration', json(calibration), isTable ? 'calibration.csv' : 'calibration.json');
  return formBody(form);
}

/** How the service would read a recording. */
export async function previewed(recording: Recording, choices: Choices, signal?: AbortSignal): Promise<Preview> {
  const { body, type } = await bodyOf([recording], choices);
  const path = withFlags('/v1/previews', choices.flags);
  return askJson<Preview>(path, { method: 'POST', body, headers: { 'Content-Type': type }, signal });
}

/** The request for one recording, or for a batch of several recordings. */
export async function submission(recordings: Recording[], choices: Choices): Promise<Submission> {
  const { flags } = choices;
  const { body, type } = await bodyOf(recordings, choices);
  const path = withFlags(recordings.length === 1 ? '/v1/fits' : '/v1/batches', flags);
  return { path, body, headers: { 'Content-Type': type, 'Idempotency-Key': newKey() } };
}

async function sentFit({ path, body, headers }: Submission, signal?: AbortSignal): Promise<string> {
  const answer = await ask(path, { method: 'POST', body, headers, signal, busy: 'Fitting' });
  const id = idOfLocation(answer.headers.get('Location'));
  if (id === null) {
    throw new ProblemError({
      title: 'An answer without an address',
      status: answer.status,
      detail: 'The service fitted the recording, but did not return its address.',
      code: 'bad_answer',
    });
  }
  results.set(id, (await answer.json()) as Result);
  return fitPath(id);
}

/** Sends the request. Returns the page address of the new fit or batch. */
export async function sent(what: Submission, signal?: AbortSignal): Promise<string> {
  if (!what.path.startsWith('/v1/batches')) return sentFit(what, signal);
  const answer = await ask(what.path, { method: 'POST', body: what.body, headers: what.headers, signal, busy: 'Sending the recordings' });
  const id = idOfLocation(answer.headers.get('Location')) ?? ((await answer.json()) as { id: string }).id;
  return batchPath(id);
}

/** Rig and calibration that replace those of a fit; undefined keeps them. */
export interface Replaced {
  rig?: Loose | null;
  calibration?: Loose | null;
}

/**
 * Fits a recording again. `flags` replace those of the fit; an empty value removes a flag. Returns the page address of
 * the new fit.
 */
export function refitted(id: string, flags: Flags, replaced: Replaced, signal?: AbortSignal): Promise<string> {
  const path = fitApi(id, 'refits');
  const key = { 'Idempotency-Key': newKey() };
  if (replaced.rig === undefined && replaced.calibration === undefined)
    return sentFit({ path: withFlags(path, flags), body: '', headers: key }, signal);
  const headers = { ...key, 'Content-Type': 'application/json' };
  return sentFit({ path, body: JSON.stringify({ options: flags, ...replaced }), headers }, signal);
}
