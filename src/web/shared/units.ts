// SPDX-License-Identifier: Apache-2.0
/** Units, symbols and names of quantities as they are displayed. */

import { el, symbolElement, type Child } from './dom';
import { embedded } from './embedded';
import { typeset } from './prose';
import type { Loose } from './result_types';

const kDegreesPerRadian = 180 / Math.PI;
const kNoBreak = '\u00a0';

/** "kg m²" for "kg m^2"; "" for "1", a pure number. */
export function unitText(unit: string): string {
  return unit === '1' ? '' : typeset(unit).replace(/\bdeg\b/g, '°').replace(/ /g, kNoBreak);
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

/** The unit in which plots show readings: degrees for angles, otherwise their own. Values are multiplied by `factor`. */
export const shownUnit = (unit: string): { unit: string; factor: number } => inDegrees(unit) ?? { unit: unitText(unit), factor: 1 };

/** The values in that unit. */
export function inShownUnit<T extends Float64Array | number[]>(values: T, unit: string): T {
  const { factor } = shownUnit(unit);
  return (factor === 1 ? values : values.map((value) => factor * value)) as T;
}

/** The number under the key `name` + "_" + unit, such as rms_residual_rad; undefined if there is none. */
export function withUnit(object: Loose | null | undefined, name: string): number | undefined {
  const isOf = (key: string): boolean => key.startsWith(`${name}_`) && key !== `${name}_std_error`;
  const found = Object.entries(object ?? {}).find(([key, value]) => isOf(key) && typeof value === 'number');
  return found?.[1] as number | undefined;
}

interface ParameterName {
  symbol: string;
  words: string;
  /** Unit of its ratio to the gravity torque G, which a fit without a rig file has. */
  unit_over_g?: string;
}

let names: Record<string, ParameterName> | null = null;

/** What the program calls a parameter: the page has it as JSON. */
function nameOf(name: string): ParameterName | undefined {
  names ??= embedded<Record<string, ParameterName>>('names') ?? {};
  return names[name];
}

/** "I_O" for inertia, "I_O/G" if its unit is that of a ratio to G; null for an unknown name. */
export function symbolOf(name: string, unit = ''): string | null {
  const found = nameOf(name);
  if (!found) return null;
  return found.symbol.replace("'", '′') + (found.unit_over_g === unit ? '/G' : '');
}

/** "moment of inertia" for inertia; an unknown name is returned unchanged. */
export const wordsOf = (name: string): string => nameOf(name)?.words || name;

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
