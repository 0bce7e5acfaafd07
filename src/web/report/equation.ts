// SPDX-License-Identifier: Apache-2.0
/** The fitted equation of motion in mathematical notation. */

/** "0.079 θ″ + 0.003 θ′ + 1.803 sin θ = 0" for "0.079 th'' + 0.003 th' + 1.803 sin th = 0". */
export function equationText(equation: string): string {
  return equation
    .replace(/th''/g, 'θ″')
    .replace(/th'/g, 'θ′')
    .replace(/\bth\b/g, 'θ')
    .replace(/\^2/g, '²')
    .replace(/ - /g, ' − ');
}
