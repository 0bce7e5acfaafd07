// SPDX-License-Identifier: Apache-2.0
/** The fitted equation of motion, integrated again for what the samples are too few to show. */

import type { Fit, Parameter } from './types';

/**
 * Accelerations of  I θ'' = -G g(θ) - T(ω),  divided by I: gravity G/I [1/s²], friction terms over I. `linear`: g is θ
 * instead of sin θ.
 */
export interface Motion {
  linear: boolean;
  gravity: number;
  viscous: number;
  coulomb: number;
  drag: number;
  stiction: number;
  stribeckRate: number;
  /** Of asymmetric dry friction: against motion towards positive angles and with the other. */
  constant: number;
}

/** θ [rad] from the zero and ω [rad/s] at equal steps; time in s from the start. */
export interface Trajectory {
  time: Float64Array;
  angle: Float64Array;
  rate: Float64Array;
}

const kKnown = new Set(['linear', 'viscous', 'coulomb', 'drag', 'stribeck', 'asymmetric']);

/** The equation of a fit; null for a law that is not known here or without estimates. */
export function motionOf(fit: Fit): Motion | null {
  const { inertia } = fit.parameters;
  if (!kKnown.has(fit.model) || !inertia?.estimate) return null;
  const I = inertia.estimate;
  const over = (parameter: Parameter | undefined): number => (parameter?.estimate ?? 0) / I;
  const gravity = fit.derived?.gravity_over_inertia?.estimate ?? (inertia.unit === 's^2' ? 1 / I : null);
  if (gravity === null || !(gravity > 0)) return null;
  const { viscous, coulomb, drag, stiction, stribeck_rate: stribeck, asymmetry } = fit.parameters;
  return {
    linear: fit.model === 'linear',
    gravity,
    viscous: over(viscous),
    coulomb: over(coulomb),
    drag: over(drag),
    stiction: stiction ? over(stiction) : over(coulomb),
    stribeckRate: stribeck?.estimate ?? 1,
    constant: over(coulomb) * (asymmetry?.estimate ?? 0),
  };
}

/** Friction over I against motion in that direction (±1), with the sign of the motion. */
function friction(m: Motion, rate: number, direction: number): number {
  const fall = Math.exp(-((rate / m.stribeckRate) ** 2));
  const dry = m.coulomb + (m.stiction - m.coulomb) * fall + m.drag * rate * rate;
  return m.viscous * rate + direction * dry + m.constant;
}

const pull = (m: Motion, angle: number): number => m.gravity * (m.linear ? angle : Math.sin(angle));

/** One step of Runge and Kutta's fourth order while the direction stays: [θ, ω] after h. */
function step(m: Motion, angle: number, rate: number, direction: number, h: number): [number, number] {
  const acceleration = (x: number, v: number): number => -pull(m, x) - friction(m, v, direction);
  const [x1, v1] = [rate, acceleration(angle, rate)];
  const [x2, v2] = [rate + 0.5 * h * v1, acceleration(angle + 0.5 * h * x1, rate + 0.5 * h * v1)];
  const [x3, v3] = [rate + 0.5 * h * v2, acceleration(angle + 0.5 * h * x2, rate + 0.5 * h * v2)];
  const [x4, v4] = [rate + h * v3, acceleration(angle + h * x3, rate + h * v3)];
  return [angle + (h / 6) * (x1 + 2 * x2 + 2 * x3 + x4), rate + (h / 6) * (v1 + 2 * v2 + 2 * v3 + v4)];
}

/** Where the pendulum goes from rest: the sign of its acceleration, 0 if friction holds it. */
function directionFromRest(m: Motion, angle: number): number {
  const force = pull(m, angle);
  const direction = -Math.sign(force);
  return Math.abs(force) <= m.stiction + direction * m.constant ? 0 : direction;
}

/** Over one interval; a reversal within is located by halving and starts anew from rest. */
function advance(m: Motion, state: [number, number], interval: number): [number, number] {
  let [angle, rate] = state;
  let left = interval;
  for (let turns = 0; left > 0 && turns < 4; ++turns) {
    const direction = rate === 0 ? directionFromRest(m, angle) : Math.sign(rate);
    if (direction === 0) return [angle, 0];
    const end = step(m, angle, rate, direction, left);
    if (end[1] * direction >= 0) return end;
    let [low, high] = [0, left];
    for (let i = 0; i < 40; ++i) {
      const middle = 0.5 * (low + high);
      if (step(m, angle, rate, direction, middle)[1] * direction > 0) low = middle;
      else high = middle;
    }
    angle = step(m, angle, rate, direction, high)[0];
    rate = 0;
    left -= high;
  }
  return [angle, rate];
}

/** The motion from (angle, rate) over `duration` s in steps of at most `interval` s. */
export function integrate(m: Motion, angle: number, rate: number, duration: number, interval: number): Trajectory {
  const steps = Math.max(1, Math.ceil(duration / interval));
  const h = duration / steps;
  const result = {
    time: new Float64Array(steps + 1),
    angle: new Float64Array(steps + 1),
    rate: new Float64Array(steps + 1),
  };
  let state: [number, number] = [angle, rate];
  for (let i = 0; i <= steps; ++i) {
    result.time[i] = i * h;
    [result.angle[i], result.rate[i]] = state;
    state = advance(m, state, h);
  }
  return result;
}

const kMostSteps = 400_000;
const kStepsPerPeriod = 120;

/**
 * The fitted motion as the sensor would show it, 120 points a period, over `window` (s on the file's clock); null where
 * the law is not known. `start`: time of the first point, s on the file's clock.
 */
export function fittedMotion(
  fit: Fit,
  window: readonly [number, number],
  clockScale: number,
): (Trajectory & { start: number }) | null {
  const m = motionOf(fit);
  const at = (name: string): number | null => fit.parameters[name]?.estimate ?? null;
  const angle = at('release_angle') ?? at('initial_angle');
  if (!m || angle === null) return null;
  const start = at('release_angle') !== null ? (at('release_time') ?? window[0]) : window[0];
  const duration = (window[1] - start) * clockScale;
  const interval = Math.max((2 * Math.PI) / Math.sqrt(m.gravity) / kStepsPerPeriod, duration / kMostSteps);
  if (!(duration > 0)) return null;
  const motion = integrate(m, angle, at('initial_rate') ?? 0, duration, interval);
  return { ...motion, time: motion.time.map((t) => start + t / clockScale), start };
}
