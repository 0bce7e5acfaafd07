// SPDX-License-Identifier: Apache-2.0
import { expect, test } from 'vitest';

import { covarianceOf, ellipse, kRegions, sum } from './ellipse';

test('the quantiles are those of tables of χ² with two degrees of freedom', () => {
  // Press et al., Numerical Recipes, section 15.6: 2.30 for 68.3 %. Tables of χ²: 5.991 for 95 %.
  expect(kRegions[0].quantile).toBeCloseTo(2.3, 2);
  expect(kRegions[1].quantile).toBeCloseTo(5.991, 3);
});

test('all points have the same distance in the metric of the covariance', () => {
  const [xx, xy, yy] = [4, -1.5, 1];
  const points = ellipse({ xx, xy, yy }, 2.5, 10, 20);
  const determinant = xx * yy - xy * xy;
  points.x.forEach((x, k) => {
    const [dx, dy] = [x - 10, points.y[k] - 20];
    expect((yy * dx * dx - 2 * xy * dx * dy + xx * dy * dy) / determinant).toBeCloseTo(2.5, 9);
  });
  // The largest deviation of each parameter is the root of the quantile times its standard error.
  expect(Math.max(...points.x) - 10).toBeCloseTo(2 * Math.sqrt(2.5), 9);
});

test('complete correlation is a line', () => {
  const points = ellipse({ xx: 1, xy: 2, yy: 4 }, 1, 0, 0);
  points.x.forEach((x, k) => expect(points.y[k]).toBeCloseTo(2 * x, 7));
});

test('the covariance of two parameters is taken by their names', () => {
  const matrix = { names: ['a', 'b', 'c'], matrix: [[1, 2, 3], [2, 5, 6], [3, 6, 9]] };
  expect(covarianceOf(matrix, 'a', 'c')).toEqual({ xx: 1, xy: 3, yy: 9 });
  expect(covarianceOf(matrix, 'a', 'd')).toBe(null);
  expect(sum({ xx: 1, xy: 2, yy: 3 }, { xx: 10, xy: -2, yy: 1 })).toEqual({ xx: 11, xy: 0, yy: 4 });
});
