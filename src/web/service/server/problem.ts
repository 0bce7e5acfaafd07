// SPDX-License-Identifier: Apache-2.0
/** Problems reported by the service (RFC 9457) or found by the page, and what to do about them. */

import { inFields } from '../flag_words';

export interface Problem {
  title: string;
  status: number;
  detail: string;
  code: string;
}

export class ProblemError extends Error {
  constructor(readonly problem: Problem) {
    super(problem.detail || problem.title);
  }
}

/** A problem of one or several form fields. The first field gets the focus. */
export class FieldError extends Error {
  constructor(
    message: string,
    readonly field: HTMLElement,
    readonly others: HTMLElement[] = [],
  ) {
    super(message);
  }
}

/** The user cancelled the action. */
export class Cancelled extends Error {}

// The sentences on a recording or an option say themselves what to do.
const kAdvice: Record<string, string> = {
  bad_request: 'Change what the sentence names, then try again.',
  unauthorized: 'Give the token that the service was started with.',
  forbidden: 'Open the page by the address that whoever runs the service gave you.',
  not_found: 'It may have been deleted. “Past fits” lists what there is.',
  timed_out: 'Choose fewer models or a shorter window, or try again when the service has less to do.',
  conflict: 'It is still under way: try again in a moment.',
  too_large: 'Send a shorter recording, or the part of it that matters.',
  unsupported_media_type: 'Choose a text file with columns of numbers, such as the CSV of a logger or a spreadsheet.',
  idempotency_key_reused: 'Try again: this counts as a new request.',
  too_many_samples: 'Choose a shorter window, --from and --to, and fit again.',
  too_many_requests: 'Wait a moment, then try again.',
  headers_too_large: 'Shorten the name or the options.',
  internal: 'This is a fault of the service, not of your file. Its log says more.',
  cannot_write: 'The service has no room left to keep fits. Whoever runs it must make some.',
  stopping: 'The service is being stopped. Try again when it is back.',
  unreachable: 'See that the service is running and that the network is there, then try again.',
  bad_answer: 'Something between this page and the service may have changed the answer. Try again.',
};

/** What to do, in a sentence; empty if there is no advice. */
export const adviceFor = ({ code }: Problem): string => inFields(kAdvice[code] ?? '');

/** The title from the service, except for problems of an address. */
export const titleOf = ({ code, title }: Problem): string =>
  code === 'not_found' ? 'There is nothing at this address' : title;

export const unreachable = (host: string): Problem => ({
  title: 'The service does not answer',
  status: 0,
  detail: `No answer came from ${host}.`,
  code: 'unreachable',
});

const isText = (value: unknown): value is string => typeof value === 'string';

/** The problem described by the body of an answer. If the body is not a problem document, the text is made here. */
export function problemFrom(status: number, body: string): Problem {
  let told: unknown = null;
  try {
    told = JSON.parse(body);
  } catch {
    // the answer is not from the service; the code below reports that
  }
  const { title, detail, code } = (told ?? {}) as Partial<Problem>;
  if (isText(title) && isText(detail)) return { title, detail, status, code: isText(code) ? code : '' };
  return {
    title: 'An answer that cannot be read',
    status,
    detail: `The answer has status ${status} and no explanation.`,
    code: status === 401 ? 'unauthorized' : 'bad_answer',
  };
}

/** Seconds of a Retry-After header, which is a number or a date; null if it is neither. */
export function retryAfter(header: string | null, now: number): number | null {
  if (header === null || header.trim() === '') return null;
  const seconds = /^\d+$/.test(header.trim()) ? Number(header) : (Date.parse(header) - now) / 1000;
  return Number.isFinite(seconds) ? Math.min(Math.max(Math.ceil(seconds), 0), 600) : null;
}

/** The problem for any thrown value. */
export function problemOf(error: unknown): Problem {
  if (error instanceof ProblemError) return error.problem;
  const detail = error instanceof Error ? error.message : String(error);
  const title = error instanceof FieldError ? 'Something is missing or wrong' : 'This page has a fault';
  return { title, status: 0, detail, code: '' };
}
