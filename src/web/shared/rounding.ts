// SPDX-License-Identifier: Apache-2.0
/** Rounds numbers of axes, cursors and sliders. Numbers with errors come as texts from the program. */

import { raised } from './prose';

const kLeastExponent = -4; // smaller numbers are written with a power of ten
const kLargestExponent = 5; // so are larger numbers that are rounded to tens or more

/**
 * How to write a number: divide by 10^exponent, then write with `decimals` (negative: rounded to tens, hundreds ...).
 */
interface Rounding {
  decimals: number;
  exponent: number;
}

/** How to write x with this number of significant digits. */
function significantRounding(x: number, digits: number): Rounding {
  if (x === 0) return { decimals: 0, exponent: 0 };
  const first = Number(x.toExponential(digits - 1).split('e')[1]);
  const last = first - digits + 1;
  const large = last > 0 && first > kLargestExponent;
  return first < kLeastExponent || large ? { decimals: digits - 1, exponent: first } : { decimals: -last, exponent: 0 };
}

/** Fixed number of decimals, with a typographic minus sign, never "−0". */
export function fixed(x: number, decimals: number): string {
  const tens = 10 ** -decimals;
  const text = decimals < 0 ? (Math.round(x / tens) * tens).toFixed(0) : x.toFixed(Math.min(decimals, 40));
  const negative = text.startsWith('-');
  const zero = !/[1-9]/.test(text);
  return negative ? (zero ? '' : '−') + text.slice(1) : text;
}

/** x with this number of significant digits, without trailing zeros; "–" for null. */
export function significant(x: number | null | undefined, digits = 4): string {
  if (x === null || x === undefined || !Number.isFinite(x)) return '–';
  const { decimals, exponent } = significantRounding(x, digits);
  const mantissa = exponent < 0 ? x * 10 ** -exponent : x / 10 ** exponent;
  const power = exponent === 0 ? '' : ` × 10${raised(String(exponent))}`;
  return (fixed(mantissa, decimals) + power)
    .replace(/(\.\d*?)0+(?= |$)/, '$1')
    .replace(/\.(?= |$)/, '');
}

const kTimeDigits = 4; // of a duration

/**
 * A time of a recording, in s, without trailing zeros: with as many decimals as the duration needs for four digits,
 * however large the time is. Clocks may begin at 50000 s.
 */
export function timeText(time: number, duration: number): string {
  const { decimals, exponent } = significantRounding(duration, kTimeDigits);
  const text = fixed(time, Math.max(0, decimals - exponent));
  return text.includes('.') ? text.replace(/\.?0+$/, '') : text;
}

/** "50490.1 to 50510.1 s"; `duration` is that of a longer recording in the same sentence. */
export function windowText([from, to]: readonly [number, number], duration = to - from): string {
  return `${timeText(from, duration)} to ${timeText(to, duration)}\u00a0s`;
}
