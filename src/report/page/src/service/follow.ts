// SPDX-License-Identifier: Apache-2.0
/** A stream of events of the service, taken up again where it broke off. */

import { ask } from './api';
import { ProblemError } from './problem';
import { EventParser, readEvents, type ServerEvent } from './sse';
import { pause } from './waiting';

const kLongest = 15; // s between attempts

export interface Follower {
  /** True ends it. */
  take: (event: ServerEvent) => boolean;
  /** A connection stands. */
  connected?: () => void;
  /** It broke off, and is tried again after so many seconds. */
  lost?: (seconds: number) => void;
}

/** Follows until `take` says that it is enough. Whatever but a lost connection is thrown. */
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
