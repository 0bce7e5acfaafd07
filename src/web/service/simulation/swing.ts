// SPDX-License-Identifier: Apache-2.0
/**
 * Integrates I θ'' = -g(θ) - T(ω, s) (MODEL.md eq. (2.1)) with the classical Runge-Kutta method in equal steps. A step
 * ends at each reversal, so it never crosses the jump of dry friction. At a reversal static friction may hold the
 * pendulum (eq. (2.9)).
 */

import type { Law } from './laws';

export interface Pendulum {
  law: Law;
  /** Over G, s². */
  inertia: number;
  /** Over G, in the order of law.names. */
  friction: readonly number[];
}

/** Held at `angle` until `time` if `rate` is 0, else in motion at `time`. s, rad, rad/s. */
export interface Start {
  time: number;
  angle: number;
  rate: number;
}

export interface Motion {
  angle: Float64Array;
  rate: Float64Array;
}

type State = [angle: number, rate: number];

const kStepsPerPeriod = 100; // errors of 1e-6 rad
const kMostSteps = 4e6;

/** Direction of the motion that follows a state; 0 if static friction holds the pendulum. */
function directionOf({ law, friction }: Pendulum, [angle, rate]: State): number {
  if (rate !== 0) return Math.sign(rate);
  const torque = law.gravity(angle);
  const direction = torque > 0 ? -1 : 1;
  return Math.abs(torque) > direction * law.friction(0, direction, friction) * (1 + 1e-12) ? direction : 0;
}

function step({ law, inertia, friction }: Pendulum, [angle, rate]: State, direction: number, dt: number): State {
  const acceleration = (at: number, w: number): number =>
    -(law.gravity(at) + law.friction(w, direction, friction)) / inertia;
  const half = 0.5 * dt;
  const a1 = acceleration(angle, rate);
  const w2 = rate + half * a1;
  const a2 = acceleration(angle + half * rate, w2);
  const w3 = rate + half * a2;
  const a3 = acceleration(angle + half * w2, w3);
  const w4 = rate + dt * a3;
  const a4 = acceleration(angle + dt * w3, w4);
  return [angle + (dt / 6) * (rate + 2 * w2 + 2 * w3 + w4), rate + (dt / 6) * (a1 + 2 * a2 + 2 * a3 + a4)];
}

/** Time in (0, dt) at which the rate vanishes; it changes its sign within the step. */
function reversalTime(pendulum: Pendulum, state: State, direction: number, dt: number): number {
  let [low, high] = [0, dt];
  for (let i = 0; i < 60 && high - low > 1e-13 * dt; ++i) {
    const middle = 0.5 * (low + high);
    if (direction * step(pendulum, state, direction, middle)[1] > 0) low = middle;
    else high = middle;
  }
  return high;
}

/** Moves `state` by dt. Returns the direction of motion at its end, 0 at rest. */
function advance(pendulum: Pendulum, state: State, direction: number, dt: number): number {
  let left = dt;
  for (let reversals = 0; reversals < 8 && direction !== 0; ++reversals) {
    const next = step(pendulum, state, direction, left);
    if (direction * next[1] > 0 || (next[1] === 0 && left === 0)) {
      [state[0], state[1]] = next;
      return direction;
    }
    const until = reversalTime(pendulum, state, direction, left);
    state[0] = step(pendulum, state, direction, until)[0];
    state[1] = 0;
    left -= until;
    direction = directionOf(pendulum, state);
    if (left <= 0) return direction;
  }
  return direction;
}

/**
 * Angle [rad] and rate [rad/s] at increasing times [s]. null: inertia is not positive, a number is not finite, or the
 * motion needs too many steps.
 */
export function swing(pendulum: Pendulum, start: Start, times: Float64Array): Motion | null {
  const longest = (2 * Math.PI * Math.sqrt(pendulum.inertia)) / kStepsPerPeriod;
  const span = (times[times.length - 1] ?? 0) - start.time;
  if (!(longest > 0) || !(span / longest < kMostSteps)) return null;
  const [angle, rate] = [new Float64Array(times.length), new Float64Array(times.length)];
  const state: State = [start.angle, start.rate];
  let direction = directionOf(pendulum, state);
  let now = start.time;
  for (let i = 0; i < times.length; ++i) {
    const room = times[i] - now;
    if (room > 0) {
      const count = direction === 0 ? 0 : Math.ceil(room / longest);
      for (let k = 0; k < count; ++k) direction = advance(pendulum, state, direction, room / count);
      now = times[i];
    }
    angle[i] = state[0];
    rate[i] = state[1];
  }
  return Number.isFinite(state[0]) ? { angle, rate } : null;
}
