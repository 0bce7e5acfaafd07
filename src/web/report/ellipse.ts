// SPDX-License-Identifier: Apache-2.0
/** Confidence regions of two parameters from their covariance. */

import type { NamedMatrix } from '../shared/result_types';

/** Variances of two parameters, and their covariance. */
export interface Covariance2 {
  xx: number;
  xy: number;
  yy: number;
}

/** −2 ln(1 − P), the quantiles of χ² with two degrees of freedom, for P = 68.27 % and 95 %. */
export const kRegions = [
  { percent: 68, quantile: -2 * Math.log(1 - 0.6827) },
  { percent: 95, quantile: -2 * Math.log(1 - 0.95) },
] as const;

/** The covariance of two parameters; null if it is not known. */
export function covarianceOf({ names, matrix }: NamedMatrix, x: string, y: string): Covariance2 | null {
  const [i, j] = [names.indexOf(x), names.indexOf(y)];
  const [xx, xy, yy] = [matrix[i]?.[i], matrix[i]?.[j], matrix[j]?.[j]];
  if (typeof xx !== 'number' || typeof xy !== 'number' || typeof yy !== 'number') return null;
  return { xx, xy, yy };
}

export const sum = (a: Covariance2, b: Covariance2): Covariance2 => ({ xx: a.xx + b.xx, xy: a.xy + b.xy, yy: a.yy + b.yy });

const kPoints = 96;

/** Points d with d' C⁻¹ d = quantile, around (x, y): L (cos φ, sin φ) times its root, L the Cholesky factor of C. */
export function ellipse({ xx, xy, yy }: Covariance2, quantile: number, x: number, y: number): { x: number[]; y: number[] } {
  const size = Math.sqrt(quantile);
  const first = Math.sqrt(xx);
  const slope = first > 0 ? xy / first : 0;
  const second = Math.sqrt(Math.max(0, yy - slope * slope));
  const angles = Array.from({ length: kPoints + 1 }, (_unused, k) => (2 * Math.PI * k) / kPoints);
  return {
    x: angles.map((angle) => x + size * first * Math.cos(angle)),
    y: angles.map((angle) => y + size * (slope * Math.cos(angle) + second * Math.sin(angle))),
  };
}
