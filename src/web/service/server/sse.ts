// SPDX-License-Identifier: Apache-2.0
/** Reads server-sent events (HTML standard) from a stream. The browser's EventSource cannot send a token. */

export interface ServerEvent {
  /** Empty before the first id. */
  id: string;
  event: string;
  data: string;
}

/** Takes the pieces of a stream and returns the events that are complete. */
export class EventParser {
  lastId = '';
  /** Delay before the next connection, ms; null until the server sends one. */
  retry: number | null = null;
  private rest = '';
  private event = '';
  private data: string[] = [];
  private begun = false;

  push(piece: string): ServerEvent[] {
    this.rest += piece;
    if (!this.begun && this.rest !== '') {
      this.begun = true;
      this.rest = this.rest.replace(/^\ufeff/, '');
    }
    const events: ServerEvent[] = [];
    for (;;) {
      const end = /\r\n|\n|\r(?!$)/.exec(this.rest); // a final \r may be the first half of \r\n
      if (!end) return events;
      const line = this.rest.slice(0, end.index);
      this.rest = this.rest.slice(end.index + end[0].length);
      if (line === '') events.push(...this.dispatch());
      else this.field(line);
    }
  }

  private dispatch(): ServerEvent[] {
    const { event, data } = this;
    this.event = '';
    this.data = [];
    return data.length === 0 ? [] : [{ id: this.lastId, event: event || 'message', data: data.join('\n') }];
  }

  private field(line: string): void {
    const colon = line.indexOf(':');
    if (colon === 0) return;
    const name = colon < 0 ? line : line.slice(0, colon);
    const value = colon < 0 ? '' : line.slice(colon + 1).replace(/^ /, '');
    if (name === 'data') this.data.push(value);
    else if (name === 'event') this.event = value;
    else if (name === 'id' && !value.includes('\0')) this.lastId = value;
    else if (name === 'retry' && /^\d+$/.test(value)) this.retry = Number(value);
  }
}

/** Calls `take` with each event of a body until it returns true. Returns false if the stream ends before. */
export async function readEvents(
  body: ReadableStream<Uint8Array>,
  parser: EventParser,
  take: (event: ServerEvent) => boolean,
): Promise<boolean> {
  const reader = body.getReader();
  const decoder = new TextDecoder();
  try {
    for (;;) {
      const { done, value } = await reader.read();
      for (const event of parser.push(decoder.decode(value, { stream: !done }))) if (take(event)) return true;
      if (done) return false;
    }
  } finally {
    await reader.cancel().catch(() => undefined);
  }
}
