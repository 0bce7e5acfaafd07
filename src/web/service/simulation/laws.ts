// SPDX-License-Identifier: Apache-2.0
/** The laws of gravity and friction (MODEL.md section 2), with torques in units of the restoring torque G. */

/** What friction depends on besides the rate. */
export interface Contact {
  /** Force on the bearing over the weight, cos θ + I ω². */
  load: number;
  /** Deflection of the bristles, as a share of that at which they slide. */
  bristle: number;
}

/** The friction torque; direction = ±1 is that of the motion. p: the parameters in the order of the law. */
type Friction = (rate: number, direction: number, p: readonly number[], contact: Contact) => number;

interface FrictionLaw {
  /** Names of the parameters of friction, in the order of `friction`. */
  names: readonly string[];
  friction: Friction;
  /** Of a law with bristles: how they bend, and the largest stiffness that they add to gravity's. */
  bristles?: {
    rate: (rate: number, bristle: number, p: readonly number[]) => number;
    stiffness: (p: readonly number[]) => number;
  };
}

export interface Law extends FrictionLaw {
  /** g(θ). */
  gravity: (angle: number) => number;
}

const kFrictions: Record<string, FrictionLaw> = {
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
  dahl: {
    names: ['viscous', 'coulomb', 'presliding_angle'],
    friction: (w, _s, [b, dry], { bristle }) => b * w + dry * bristle,
    bristles: {
      rate: (w, bristle, [, , angle]) => (w - Math.abs(w) * bristle) / angle,
      stiffness: ([, dry, angle]) => (2 * dry) / angle,
    },
  },
  load: {
    names: ['viscous', 'load_friction'],
    friction: (w, s, [b, dry], { load }) => b * w + s * dry * Math.abs(load),
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

const kTorques = ['viscous', 'coulomb', 'drag', 'stiction', 'load_friction'];

/** Whether a parameter is a torque, which G divides. */
export const isTorque = (name: string): boolean => kTorques.includes(name);
