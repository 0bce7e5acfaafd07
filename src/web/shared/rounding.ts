// SPDX-License-Identifier: Apache-2.0
/** Rounds numbers: errors as the Particle Data Group does, values to the decimals of their errors. */

const kMostDigits = 12; // of a value, even if its error is smaller
const kLeastExponent = -4; // smaller numbers are written with a power of ten
const kLeastOfSecond = -7; // the same for a second error of a value
const kLargestExponent = 5; // so are larger numbers that are rounded to tens or more
const kSuperscripts = '⁰¹²³⁴⁵⁶⁷⁸⁹';

/**
 * How to write a number: divide by 10^exponent, then write with `decimals` (negative: rounded to tens, hundreds ...).
 */
export interface Rounding {
  decimals: number;
  exponent: number;
}

/** The three leading decimal digits (100 to 999) of x ≠ 0, and the power of ten of the first digit. */
function leadingDigits(x: number): { digits: number; exponent: number } {
  const [mantissa, exponent] = Math.abs(x).toExponential().split('e');
  const digits = mantissa.replace('.', '').padEnd(3, '0').slice(0, 3);
  return { digits: Number(digits), exponent: Number(exponent) };
}

/** The rounded error, the power of ten of its first digit, and that of its last digit. Halves are rounded up. */
function roundError(error: number): { first: number; last: number; error: number } {
  const { digits, exponent } = leadingDigits(error);
  if (digits <= 354)
    return { first: exponent, last: exponent - 1, error: Math.floor((digits + 5) / 10) * 10 ** (exponent - 1) };
  if (digits <= 949) return { first: exponent, last: exponent, error: Math.floor((digits + 50) / 100) * 10 ** exponent };
  return { first: exponent + 1, last: exponent, error: 10 ** (exponent + 1) };
}

/** The power of ten of the first digit of x after rounding to the digit 10^last; -Infinity if x is rounded to zero. */
function firstDigit(x: number, last: number): number {
  if (x === 0) return -Infinity;
  const { exponent } = leadingDigits(x);
  const units = Math.round(Math.abs(x) / 10 ** last);
  if (units === 0) return -Infinity;
  return units >= 10 ** (Math.max(exponent, last - 1) - last + 1) ? Math.max(exponent, last - 1) + 1 : exponent;
}

function roundingTo(first: number, last: number): Rounding {
  const end = Math.max(last, first - kMostDigits + 1);
  const large = end > 0 && first > kLargestExponent;
  if (first < kLeastExponent || large) return { decimals: Math.max(0, first - end), exponent: first };
  return { decimals: -end, exponent: 0 };
}

/**
 * Rounding of value ± error (error > 0): two digits of the error if its three leading digits are below 355, else one
 * digit (Particle Data Group, "Rounding").
 */
export function pdgRounding(value: number, error: number): Rounding {
  const { first, last } = roundError(error);
  return roundingTo(Math.max(first, firstDigit(value, last)), last);
}

/** Rounding of x to this number of significant digits. */
export function significantRounding(x: number, digits: number): Rounding {
  if (x === 0) return { decimals: 0, exponent: 0 };
  const first = leadingDigits(Number(x.toPrecision(digits))).exponent;
  return roundingTo(first, first - digits + 1);
}

/** Fixed number of decimals, with a typographic minus sign, never "−0". */
export function fixed(x: number, decimals: number): string {
  const tens = 10 ** -decimals;
  const text = decimals < 0 ? (Math.round(x / tens) * tens).toFixed(0) : x.toFixed(Math.min(decimals, 40));
  const negative = text.startsWith('-');
  const zero = !/[1-9]/.test(text);
  return negative ? (zero ? '' : '−') + text.slice(1) : text;
}

function powerOfTen(exponent: number): string {
  const digits = [...String(Math.abs(exponent))].map((digit) => kSuperscripts[Number(digit)]).join('');
  return `10${exponent < 0 ? '⁻' : ''}${digits}`;
}

function scaled(x: number, rounding: Rounding): string {
  const mantissa = rounding.exponent < 0 ? x * 10 ** -rounding.exponent : x / 10 ** rounding.exponent;
  return fixed(mantissa, rounding.decimals);
}

/** x in the given rounding: "0.0790", "1.23 × 10⁻⁶". */
export function rounded(x: number, rounding: Rounding): string {
  const power = rounding.exponent === 0 ? '' : ` × ${powerOfTen(rounding.exponent)}`;
  return scaled(x, rounding) + power;
}

/** x with this number of significant digits, without trailing zeros; "–" for null. */
export function significant(x: number | null | undefined, digits = 4): string {
  if (x === null || x === undefined || !Number.isFinite(x)) return '–';
  const rounding = significantRounding(x, digits);
  return rounded(x, rounding)
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

/** "0.0790 ± 0.0028", "(1.2 ± 0.3) × 10⁻⁶"; only the value if there is no error. */
export function plusMinus(value: number | null, error: number | null | undefined): string {
  if (value === null || !Number.isFinite(value)) return '–';
  if (error === null || error === undefined || !(error > 0)) return significant(value, 6);
  const rounding = pdgRounding(value, error);
  const both = `${scaled(value, rounding)} ± ${scaled(roundError(error).error, rounding)}`;
  return rounding.exponent === 0 ? both : `(${both}) × ${powerOfTen(rounding.exponent)}`;
}

/** A second error of a value, rounded by itself: "0.0028". It has a power of ten if the value ± its first error has one. */
export function errorText(
  error: number | null | undefined,
  value: number | null,
  first: number | null | undefined,
): string {
  if (error === null || error === undefined || !Number.isFinite(error)) return '–';
  if (!(error > 0)) return '0';
  const own = pdgRounding(error, error);
  const near = own.exponent < 0 && own.exponent >= kLeastOfSecond && value !== null && first;
  const plain = near ? pdgRounding(value, first).exponent === 0 : false;
  const shown = plain ? { exponent: 0, decimals: own.decimals - own.exponent } : own;
  return rounded(roundError(error).error, shown);
}

/** A probability: "0.43", "2 × 10⁻⁹", "< 10⁻⁹⁹". */
export function probabilityText(p: number | null | undefined): string {
  if (p === null || p === undefined) return '–';
  if (p < 1e-99) return '< 10⁻⁹⁹';
  if (p < 1e-3) return significant(p, 1);
  return significant(p, 2);
}
