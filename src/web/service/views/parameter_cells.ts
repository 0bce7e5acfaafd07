// SPDX-License-Identifier: Apache-2.0
/** Cells of a table of parameters of several fits. */

import { el } from '../../shared/dom';
import type { Parameter } from '../../shared/result_types';
import { plusMinus } from '../../shared/rounding';
import type { Cell } from '../../shared/table';
import { inDegrees, spacedUnit } from '../../shared/units';

/** Parameters of the start and of the sensor. All others are properties of the pendulum. */
export const kCircumstances = new Set([
  'release_angle',
  'release_time',
  'initial_angle',
  'initial_rate',
  'zero_angle',
  'rate_bias',
  'zero_drift',
  'bias_drift',
  'rate_scale',
  'acceleration_bias',
  'acceleration_scale',
  'axis',
  'radius',
  'pivot_x',
  'pivot_y',
  'hysteresis',
]);

const scale = (x: number | null, factor: number): number | null => (x === null ? null : factor * x);

/** "0.4229 ± 0.0002 rad" */
function valueText(value: number | null, error: number | null, unit: string): string {
  return plusMinus(value, error) + (value === null ? '' : spacedUnit(unit));
}

function degreesText(value: number | null, error: number | null, unit: string): string | null {
  const degrees = inDegrees(unit);
  if (!degrees || value === null) return null;
  const both = plusMinus(scale(value, degrees.factor), scale(error, degrees.factor));
  return both.includes('±')
    ? `(${both.replace(/^\((.*)\)( ×.*)$/, '$1$2')})${degrees.unit}`
    : `(${both}${degrees.unit})`;
}

/** Value and total error: the statistical error alone where nothing systematic is known. */
export function valueCell({ estimate, total_std_error: total, std_error: noise, unit }: Parameter): Cell {
  const error = total ?? noise;
  const degrees = degreesText(estimate, error, unit);
  return [valueText(estimate, error, unit), degrees !== null && el('small', {}, degrees)];
}
