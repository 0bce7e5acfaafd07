// SPDX-License-Identifier: Apache-2.0
/**
 * Sends requests to the service: adds the token, repeats them when the service is busy, throws its problems as
 * ProblemError.
 */

import { waitFor, whileBusy } from '../waiting';
import { problemFrom, ProblemError, retryAfter, unreachable, type Problem } from './problem';
import { askToken, token } from './token';

export interface Ask {
  method?: 'GET' | 'POST' | 'PATCH' | 'DELETE';
  body?: Blob | string;
  headers?: Record<string, string>;
  signal?: AbortSignal;
  /** What the service does, if it may take long: "Fitting". The page shows it, with a button that cancels it. */
  busy?: string;
}

const kMostRepeats = 5;
const kBusy = new Set([408, 409, 429, 503]);

/** A key by which the service recognizes a repeated request. crypto.randomUUID exists only on secure pages. */
export function newKey(): string {
  const bytes = crypto.getRandomValues(new Uint8Array(16));
  return [...bytes].map((byte) => byte.toString(16).padStart(2, '0')).join('');
}

async function send(
  path: string,
  { method = 'GET', body, headers = {}, signal }: Ask,
  used: string,
): Promise<Response> {
  const all = used === '' ? headers : { ...headers, Authorization: `Bearer ${used}` };
  try {
    return await fetch(path, { method, body, headers: all, signal, cache: 'no-store' });
  } catch (error) {
    signal?.throwIfAborted();
    throw new ProblemError(unreachable(location.host));
  }
}

/** Seconds to wait before the request is repeated; null if it must not be repeated. */
function secondsToWait(answer: Response, problem: Problem, repeats: number): number | null {
  if (!kBusy.has(answer.status) || repeats >= kMostRepeats) return null;
  const said = retryAfter(answer.headers.get('Retry-After'), Date.now());
  if (said === null) return problem.code === 'conflict' ? null : 2 ** repeats;
  return Math.max(1, said);
}

/**
 * The successful answer. ProblemError: the service refused. Cancelled: the user did not want to wait, or gave no token.
 */
export async function ask(path: string, options: Ask = {}): Promise<Response> {
  for (let repeats = 0; ;) {
    const used = token();
    const answer = await (options.busy === undefined
      ? send(path, options, used)
      : whileBusy(options.busy, (signal) => send(path, { ...options, signal }, used), options.signal));
    if (answer.ok) return answer;
    const problem = problemFrom(answer.status, await answer.text());
    if (answer.status === 401) {
      if (used === token()) await askToken(used !== '');
      continue;
    }
    const seconds = secondsToWait(answer, problem, repeats++);
    if (seconds === null) throw new ProblemError(problem);
    await waitFor(problem, seconds, options.signal);
  }
}

/** The JSON of an answer. */
export async function askJson<T>(path: string, options: Ask = {}): Promise<T> {
  const answer = await ask(path, options);
  const body = await answer.text();
  try {
    return JSON.parse(body) as T;
  } catch {
    throw new ProblemError(problemFrom(answer.status, ''));
  }
}

/**
 * A form as one body, so that a repeated request has the same bytes, and its content type. A Blob would change the type
 * to lower case.
 */
export async function formBody(form: FormData): Promise<{ body: Blob; type: string }> {
  const made = new Response(form);
  const type = made.headers.get('Content-Type') ?? 'multipart/form-data';
  return { body: await made.blob(), type };
}
