// SPDX-License-Identifier: Apache-2.0
/** The laws of gravity and friction (MODEL.md section 2), with torques in units of the restoring torque G. */

/** The friction torque T(ω, s); s = ±1 is the direction of motion. p: the parameters in the order of the law. */
type Friction = (rate: number, direction: number, p: readonly number[]) => number;

export interface Law {
  /** Names of the parameters of friction, in the order of `friction`. */
  names: readonly string[];
  friction: Friction;
  /** g(θ). */
  gravity: (angle: number) => number;
}

const kFrictions: Record<string, { names: readonly string[]; friction: Friction }> = {
  viscous: { names: ['viscous'], friction: (w, _s, [b]) => b * w },
  coulomb: { names: ['viscous', 'coulomb'], friction: (w, s, [b, dry]) => b * w + s * dry },
  drag: { names: ['viscous', 'coulomb', 'drag'], friction: (w, s, [b, dry, c]) => b * w + s * (dry + c * w * w) },
  stribeck: {
    names: ['viscous', 'coulomb', 'stiction', 'stribeck_rate'],
    friction: (w, s, [b, dry, stiction, scale]) =>
      b * w + s * (dry + (stiction - dry) * Math.exp(-((w / scale) ** 2))),
  },
  asymmetric: {
    names: ['viscous', 'coulomb', 'asymmetry'],
    friction: (w, s, [b, dry, asymmetry]) => b * w + s * dry * (1 + s * asymmetry),
  },
};

const linear = (angle: number): number => angle;

/** The law of a model: "coulomb", or "linear_coulomb" with the torque of a spring. null: unknown to this page. */
export function lawOf(model: string): Law | null {
  const isLinear = model === 'linear' || model.startsWith('linear_');
  const friction = model === 'linear' ? 'viscous' : isLinear ? model.slice('linear_'.length) : model;
  const found = Object.hasOwn(kFrictions, friction) ? kFrictions[friction] : null;
  return found && { ...found, gravity: isLinear ? linear : Math.sin };
}

/** Whether a parameter is a torque, which G divides. */
export const isTorque = (name: string): boolean => ['viscous', 'coulomb', 'drag', 'stiction'].includes(name);
