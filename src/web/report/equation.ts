// SPDX-License-Identifier: Apache-2.0
/** The fitted equation of motion in mathematical notation. */

import type { Fit } from '../shared/result_types';

/** "0.079 θ″ + 0.003 θ′ + 1.803 sin θ = 0" for "0.079 th'' + 0.003 th' + ..."; null if the result has no equation. */
export function equationText(fit: Fit): string | null {
  if (!fit.equation) return null;
  return fit.equation
    .replace(/th''/g, 'θ″')
    .replace(/th'/g, 'θ′')
    .replace(/\bth\b/g, 'θ')
    .replace(/\^2/g, '²')
    .replace(/ - /g, ' − ');
}
