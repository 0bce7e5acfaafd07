// SPDX-License-Identifier: Apache-2.0
import { afterEach, expect, test, vi } from 'vitest';

import { readingsOf } from './readings';

vi.mock('./token', () => ({ token: () => '', askToken: () => Promise.reject(new Error('no token')) }));
vi.mock('../waiting', () => ({
  waitFor: () => Promise.resolve(),
  whileBusy: (_words: string, work: (signal: AbortSignal) => Promise<Response>) => work(new AbortController().signal),
}));

const kRequest = { parameters: { inertia: 0.08 }, model: 'coulomb', recording: 0 };
const kReadings = { time_s: [0, 1], value: [0.1, 0.2], unit: 'rad', rms_residual: 0.5 };

const problem = (status: number, code: string, detail: string): Response =>
  new Response(JSON.stringify({ title: 'A problem', detail, code }), { status });

/** Answers requests in turn, and returns their paths and bodies. */
function served(...answers: Response[]): [string, unknown][] {
  const asked: [string, unknown][] = [];
  vi.stubGlobal('fetch', (path: string, { body }: RequestInit) => {
    asked.push([path, body]);
    return Promise.resolve(answers.shift()!);
  });
  return asked;
}

afterEach(() => vi.unstubAllGlobals());

test('the values are sent and the readings come back', async () => {
  const asked = served(Response.json(kReadings));
  expect(await readingsOf('a', kRequest)).toEqual(kReadings);
  expect(asked).toEqual([['/v1/fits/a/readings', JSON.stringify(kRequest)]]);
});

test('a fit that the service does not hold is made again by asking for its series, once', async () => {
  const lost = (): Response => problem(409, 'conflict', 'ask for the series');
  const asked = served(lost(), Response.json([]), Response.json(kReadings));
  expect(await readingsOf('a', kRequest)).toEqual(kReadings);
  expect(asked.map(([path]) => path)).toEqual(['/v1/fits/a/readings', '/v1/fits/a/series', '/v1/fits/a/readings']);
  served(lost(), Response.json([]), lost());
  await expect(readingsOf('a', kRequest)).rejects.toThrow('ask for the series');
});

test('a fit that the service never holds is not made again', async () => {
  const asked = served(problem(422, 'too_many_samples', 'this fit used 150000 samples'));
  await expect(readingsOf('a', kRequest)).rejects.toThrow('150000 samples');
  expect(asked.length).toBe(1);
});

test('another problem is passed on', async () => {
  const asked = served(problem(400, 'bad_request', 'inertia is -1'));
  await expect(readingsOf('a', kRequest)).rejects.toThrow('inertia is -1');
  expect(asked.length).toBe(1);
});
