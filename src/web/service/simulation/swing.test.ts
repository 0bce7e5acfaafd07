// SPDX-License-Identifier: Apache-2.0
/**
 * Against trajectories.json, which simulate_pendulum wrote: --duration 20 --rate 4 --unit rad, without noise, with the
 * model and parameters of each entry. That program integrates with Taylor series, independently of this page.
 */

import { expect, test } from 'vitest';

import { lawOf } from './laws';
import { swing } from './swing';
import trajectories from './trajectories.json';

type Case = { model: string; parameters: Record<string, number>; interval_s: number; angle: number[] };

for (const [i, { model, parameters, interval_s, angle }] of (trajectories as unknown as Case[]).entries()) {
  test(`trajectory ${i} (${model}) is that of simulate_pendulum`, () => {
    const law = lawOf(model)!;
    const times = Float64Array.from(angle, (_angle, k) => k * interval_s);
    const start = {
      time: parameters.release_time ?? 0,
      angle: parameters.release_angle ?? parameters.initial_angle,
      rate: parameters.initial_rate ?? 0,
    };
    const friction = law.names.map((name) => parameters[name] ?? 0);
    const motion = swing({ law, inertia: parameters.inertia, friction }, start, times)!;
    const worst = Math.max(...angle.map((expected, k) => Math.abs(motion.angle[k] - expected)));
    expect(worst).toBeLessThan(1e-4); // rad
  });
}

test('dry friction holds a pendulum whose gravity torque is not larger', () => {
  const law = lawOf('coulomb')!;
  const times = Float64Array.of(0, 1, 2);
  const released = (angle: number): number =>
    swing({ law, inertia: 0.04, friction: [0, 0.1] }, { time: 0, angle, rate: 0 }, times)!.angle[2];
  expect(released(Math.asin(0.1))).toBe(Math.asin(0.1)); // |sin θ| = τ_c/G
  expect(released(1.01 * Math.asin(0.1))).toBeLessThan(Math.asin(0.1));
});

test('a pendulum without friction keeps its energy', () => {
  const pendulum = { law: lawOf('viscous')!, inertia: 0.04, friction: [0] };
  const times = Float64Array.from({ length: 200 }, (_x, k) => 0.5 * k);
  const { angle, rate } = swing(pendulum, { time: 0, angle: 2, rate: 0 }, times)!;
  const energy = (k: number): number => 0.5 * 0.04 * rate[k] ** 2 + 1 - Math.cos(angle[k]);
  for (let k = 0; k < times.length; ++k) expect(energy(k)).toBeCloseTo(energy(0), 5);
});

test('an inertia that is not positive gives no motion', () => {
  const at = (inertia: number): unknown =>
    swing({ law: lawOf('viscous')!, inertia, friction: [0] }, { time: 0, angle: 1, rate: 0 }, Float64Array.of(0, 1));
  expect(at(0)).toBeNull();
  expect(at(-1)).toBeNull();
  expect(lawOf('magnetic')).toBeNull();
  expect(lawOf('toString')).toBeNull();
});
