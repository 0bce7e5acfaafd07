// SPDX-License-Identifier: Apache-2.0
/** Units, symbols and names of quantities as they are displayed. */

import { el, symbolElement, type Child } from './dom';
import type { Loose } from './result_types';

const kSuperscript: Record<string, string> = { '-': '⁻', '0': '⁰', '1': '¹', '2': '²', '3': '³', '4': '⁴' };
const kDegreesPerRadian = 180 / Math.PI;
const kNoBreak = '\u00a0';

/** "kg m²" for "kg m^2"; "" for "1", a pure number. */
export function unitText(unit: string): string {
  if (unit === '1') return '';
  const raised = unit.replace(/\^(-?\d+)/g, (_all, power: string) =>
    [...power].map((c) => kSuperscript[c] ?? c).join(''),
  );
  return raised.replace(/\bdeg\b/g, '°').replace(/ /g, kNoBreak);
}

/** The unit after a space; "" for a pure number. */
export function spacedUnit(unit: string): string {
  const text = unitText(unit);
  return text === '' ? '' : kNoBreak + text;
}

/** Conversion to degrees; null unless the unit is that of an angle or an angular rate. */
export function inDegrees(unit: string): { unit: string; factor: number } | null {
  if (unit === 'rad') return { unit: '°', factor: kDegreesPerRadian };
  if (unit === 'rad/s') return { unit: '°/s', factor: kDegreesPerRadian };
  return null;
}

/** Units by the suffixes of the keys in the JSON. */
const kUnitOfSuffix: Record<string, string> = { rad: 'rad', rad_s: 'rad/s', counts: 'counts', volts: 'V', m_s2: 'm/s²', m: 'm', px: 'px' };

/** The number under the key `name` + "_" + unit, such as rms_residual_rad, with its unit; null if there is none. */
export function withUnit(object: Loose | null | undefined, name: string): { value: number; unit: string } | null {
  for (const [suffix, unit] of Object.entries(kUnitOfSuffix)) {
    const value = object?.[`${name}_${suffix}`];
    if (typeof value === 'number') return { value, unit };
  }
  return null;
}

const kSymbols: Record<string, string> = {
  inertia: 'I_O',
  viscous: 'b',
  coulomb: 'τ_c',
  drag: 'c',
  stiction: 'τ_s',
  stribeck_rate: 'ω_s',
  asymmetry: 'α',
  presliding_angle: 'θ_p',
  load_friction: 'τ_l',
  release_angle: 'θ_r',
  release_time: 't_r',
  initial_angle: 'θ_0',
  initial_rate: 'ω_0',
  zero_angle: 'z',
  rate_bias: 'z',
  zero_drift: 'z′',
  bias_drift: 'z′',
  rate_scale: 'k',
  acceleration_bias: 'c',
  acceleration_scale: 'k',
  axis: 'ψ',
  radius: 'r',
  pivot_x: 'x_P',
  pivot_y: 'y_P',
  hysteresis: 'h',
};

/** Units of ratios to the gravity torque G, which a fit without a rig file has. */
const kUnitOverG: Record<string, string> = {
  inertia: 's^2',
  viscous: 's',
  coulomb: '1',
  stiction: '1',
  load_friction: '1',
  drag: 's^2',
};

const kWords: Record<string, string> = {
  inertia: 'moment of inertia',
  viscous: 'viscous friction',
  coulomb: 'dry friction',
  drag: 'air drag',
  stiction: 'static friction',
  stribeck_rate: 'Stribeck rate',
  asymmetry: 'asymmetry of friction',
  presliding_angle: 'presliding angle',
  load_friction: 'dry friction under the weight',
  release_angle: 'release angle',
  release_time: 'release time',
  initial_angle: 'initial angle',
  initial_rate: 'initial rate',
  zero_angle: 'zero of the sensor',
  rate_bias: 'bias of the sensor',
  zero_drift: 'drift of the zero',
  bias_drift: 'drift of the bias',
  rate_scale: 'scale of the gyro',
  acceleration_bias: 'bias of the accelerometer',
  acceleration_scale: 'scale of the accelerometer',
  axis: 'axis of the accelerometer',
  radius: 'distance from the pivot',
  pivot_x: 'pivot, horizontally',
  pivot_y: 'pivot, vertically',
  hysteresis: 'hysteresis of the encoder',
};

/** "I_O" for inertia, "I_O/G" if its unit is that of a ratio to G; null for an unknown name. */
export function symbolOf(name: string, unit = ''): string | null {
  const symbol = kSymbols[name];
  if (symbol === undefined) return null;
  return kUnitOverG[name] === unit ? `${symbol}/G` : symbol;
}

/** "moment of inertia" for inertia; an unknown name is returned unchanged. */
export const wordsOf = (name: string): string => kWords[name] ?? name;

/** Name in words, symbol, and the name in flags and JSON. */
export function quantityName(name: string, unit = ''): Child[] {
  const symbol = symbolOf(name, unit);
  const words = wordsOf(name);
  return [
    words,
    symbol !== null && ' ',
    symbol !== null && symbolElement(symbol),
    words !== name && el('code', {}, name),
  ];
}

/** Name of the quantity that has this unit. */
export const quantityOf = (unit: string): string => (unit === 'rad/s' ? 'rate' : unit === 'rad' ? 'angle' : 'reading');
