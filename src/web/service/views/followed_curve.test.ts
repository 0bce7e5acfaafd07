// SPDX-License-Identifier: Apache-2.0
import { expect, test } from 'vitest';

import { Cancelled } from '../server/problem';
import { FollowedCurve, type Curve } from './followed_curve';

const curve = (rms: number): Curve => ({ time: Float64Array.of(0, 1), values: Float64Array.of(rms, rms), rms });
const kBest = curve(0.1);

/** A followed curve whose answers come when they are told to, and what it has shown. */
function followed() {
  const shown: [number, unknown][] = [];
  const asked: { give: (curve: Curve) => void; refuse: (error: unknown) => void; signal: AbortSignal }[] = [];
  const left = new AbortController();
  const ask = (_changed: Record<string, number>, signal: AbortSignal): Promise<Curve> =>
    new Promise((give, refuse) => asked.push({ give, refuse, signal }));
  const curves = new FollowedCurve(kBest, ask, ({ rms }, problem) => shown.push([rms, problem]), left.signal);
  return { curves, shown, asked, left };
}

const settled = (): Promise<void> => new Promise((resolve) => setTimeout(resolve));

test('the curve of the changed parameters is shown, and none after a problem', async () => {
  const { curves, shown, asked } = followed();
  void curves.follow({ inertia: 2 });
  asked[0].give(curve(0.5));
  await settled();
  const problem = new Error('friction holds it');
  void curves.follow({ coulomb: 9 });
  asked[1].refuse(problem);
  await settled();
  expect(shown).toEqual([
    [0.5, undefined],
    [NaN, problem],
  ]);
});

test('a reader who cancels keeps the last curve', async () => {
  const { curves, shown, asked } = followed();
  const cancelled = new Cancelled('Fitting again: cancelled.');
  void curves.follow({ inertia: 2 });
  asked[0].refuse(cancelled);
  await settled();
  void curves.follow({ inertia: 3 });
  asked[1].give(curve(0.5));
  await settled();
  void curves.follow({ inertia: 4 });
  asked[2].refuse(cancelled);
  await settled();
  expect(shown).toEqual([
    [kBest.rms, cancelled],
    [0.5, undefined],
    [0.5, cancelled],
  ]);
});

test('the curve of the fit is shown at once, and the running request is dropped', async () => {
  for (const end of ['give', 'refuse'] as const) {
    const { curves, shown, asked } = followed();
    void curves.follow({ inertia: 2 });
    void curves.follow({ inertia: 3 });
    void curves.follow({});
    expect(shown).toEqual([[kBest.rms, undefined]]);
    expect(asked[0].signal.aborted).toBe(true);
    if (end === 'give') asked[0].give(curve(0.5));
    else asked[0].refuse(asked[0].signal.reason);
    await settled();
    expect(shown.length).toBe(1);
    expect(asked.length).toBe(1);
  }
});

test('nothing is shown after the reader has left', async () => {
  const { curves, shown, asked, left } = followed();
  void curves.follow({ inertia: 2 });
  left.abort();
  asked[0].refuse(left.signal.reason);
  await settled();
  expect(shown).toEqual([]);
});

test('an exception while a curve is shown does not stop the next one', async () => {
  const shown: number[] = [];
  const ask = ({ rms }: Record<string, number>): Promise<Curve> => Promise.resolve(curve(rms));
  const show = ({ rms }: Curve): void => {
    if (rms === 1) throw new Error('the plot is gone');
    shown.push(rms);
  };
  const curves = new FollowedCurve(kBest, ask, show, new AbortController().signal);
  await expect(curves.follow({ rms: 1 })).rejects.toThrow('the plot is gone');
  await curves.follow({ rms: 2 });
  expect(shown).toEqual([2]);
});
