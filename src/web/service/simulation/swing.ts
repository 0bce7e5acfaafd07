// SPDX-License-Identifier: Apache-2.0
/**
 * Integrates I θ'' = -g(θ) - T(ω, s) (MODEL.md eq. (2.1)) with the classical Runge-Kutta method in equal steps. A step
 * ends at each reversal, so it never crosses the jump of dry friction. At a reversal static friction may hold the
 * pendulum (eq. (2.9)), or bristles spring back (eq. (2.10)).
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

/** Angle, rate, and deflection of the bristles. */
type State = [angle: number, rate: number, bristle: number];

const kStepsPerPeriod = 100; // errors of 1e-6 rad
const kMostSteps = 4e6;

const frictionAt = ({ law, inertia, friction }: Pendulum, [angle, rate, bristle]: State, direction: number): number =>
  law.friction(rate, direction, friction, { load: Math.cos(angle) + inertia * rate * rate, bristle });

/** Direction of the motion that follows a state; 0 if static friction holds the pendulum, which bristles cannot. */
function directionOf(pendulum: Pendulum, state: State): number {
  const [angle, rate] = state;
  if (rate !== 0) return Math.sign(rate);
  const gravity = pendulum.law.gravity(angle);
  if (pendulum.law.bristles) return -Math.sign(gravity + frictionAt(pendulum, state, 1));
  const direction = gravity > 0 ? -1 : 1;
  return Math.abs(gravity) > direction * frictionAt(pendulum, state, direction) * (1 + 1e-12) ? direction : 0;
}

function changeOf(pendulum: Pendulum, state: State, direction: number): State {
  const { law, inertia, friction } = pendulum;
  const [angle, rate, bristle] = state;
  const acceleration = -(law.gravity(angle) + frictionAt(pendulum, state, direction)) / inertia;
  return [rate, acceleration, law.bristles ? law.bristles.rate(rate, bristle, friction) : 0];
}

function step(pendulum: Pendulum, state: State, direction: number, dt: number): State {
  const moved = (change: State, time: number): State => [
    state[0] + time * change[0],
    state[1] + time * change[1],
    state[2] + time * change[2],
  ];
  const k1 = changeOf(pendulum, state, direction);
  const k2 = changeOf(pendulum, moved(k1, 0.5 * dt), direction);
  const k3 = changeOf(pendulum, moved(k2, 0.5 * dt), direction);
  const k4 = changeOf(pendulum, moved(k3, dt), direction);
  const mean = (n: number): number => (k1[n] + 2 * k2[n] + 2 * k3[n] + k4[n]) / 6;
  return moved([mean(0), mean(1), mean(2)], dt);
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
      [state[0], state[1], state[2]] = next;
      return direction;
    }
    const until = reversalTime(pendulum, state, direction, left);
    [state[0], , state[2]] = step(pendulum, state, direction, until);
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
  const { law, inertia, friction } = pendulum;
  const stiffness = 1 + (law.bristles?.stiffness(friction) ?? 0);
  const longest = (2 * Math.PI * Math.sqrt(inertia / stiffness)) / kStepsPerPeriod;
  const span = (times[times.length - 1] ?? 0) - start.time;
  if (!(longest > 0) || !(span / longest < kMostSteps)) return null;
  const [angle, rate] = [new Float64Array(times.length), new Float64Array(times.length)];
  const state: State = [start.angle, start.rate, Math.sign(start.rate || start.angle)]; // slid until now
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
