// SPDX-License-Identifier: Apache-2.0
/** Follows a stream of events of the service, and connects again after an interruption. */

import { ask } from './server/api';
import { ProblemError } from './server/problem';
import { EventParser, readEvents, type ServerEvent } from './server/sse';
import { pause } from './waiting';

const kLongest = 15; // s between attempts

export interface Follower {
  /** Returns true to end the stream. */
  take: (event: ServerEvent) => boolean;
  /** Called when the connection is established. */
  connected?: () => void;
  /** Called when the connection is lost. The next attempt is after `seconds`. */
  lost?: (seconds: number) => void;
}

/** Follows until `take` returns true. Throws all errors except a lost connection. */
export async function follow(path: string, { take, connected, lost }: Follower, signal: AbortSignal): Promise<void> {
  let lastId = '';
  for (let attempts = 0; ;) {
    const parser = new EventParser();
    parser.lastId = lastId;
    try {
      const headers: Record<string, string> = { Accept: 'text/event-stream' };
      if (lastId !== '') headers['Last-Event-ID'] = lastId;
      const { body } = await ask(path, { headers, signal });
      connected?.();
      attempts = 0;
      if (body && (await readEvents(body, parser, take))) return;
    } catch (error) {
      signal.throwIfAborted();
      const network = error instanceof TypeError;
      if (!network && !(error instanceof ProblemError && error.problem.code === 'unreachable')) throw error;
    }
    signal.throwIfAborted();
    ({ lastId } = parser);
    const seconds = Math.min(kLongest, parser.retry === null ? 2 ** attempts++ : parser.retry / 1000);
    lost?.(seconds);
    await pause(seconds, signal);
  }
}
